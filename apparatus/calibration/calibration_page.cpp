#include "apparatus/calibration/calibration_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"
#include "apparatus/report/run_files/glossary.hpp"

namespace tremie::calibration {
namespace {

using report::person_number;
using report::unit_for_people;
using report::with_unit;
using report::words_of;

constexpr double faint = 0.01;  ///< of the largest density: what is not drawn

std::string interval_text(const Estimated& p) {
  return fmt::format("{:.3g}{} ({:.3g} to {:.3g})", p.value, p.unit.empty() ? "" : " " + p.unit, p.low,
                     p.high);
}

const char* told_in_words(const std::string& told) {
  return told == "identified" ? "identified"
         : told == "bound"    ? "only bound: the interval is wide or lies at an end of the range"
                              : "not identifiable: nearly all of the range is equally likely";
}

/// Cells along an unknown: those of the quadrature where it is a grid, so that no cell is empty by chance.
std::size_t cells_along(std::size_t unknowns) { return unknowns == 1 ? 401 : unknowns == 2 ? 71 : 30; }

std::size_t cell_of(double share, std::size_t n) {
  return std::min(n - 1, static_cast<std::size_t>(std::max(0.0, share * static_cast<double>(n))));
}

double value_at(const Lab& lab, std::size_t unknown, double cell, std::size_t n) {
  return study::level_at(lab.unknowns[unknown], cell / static_cast<double>(n)).number;
}

report::Figure marginal(const Lab& lab, const Calibration& c, std::size_t unknown) {
  const std::size_t n = cells_along(lab.unknowns.size());
  std::vector<double> weight(n, 0.0), at(n);
  for (std::size_t i = 0; i < c.posterior.points.size(); ++i)
    weight[cell_of(c.posterior.points[i][unknown], n)] += c.posterior.weights[i];
  const double most = *std::max_element(weight.begin(), weight.end());
  for (std::size_t i = 0; i < n; ++i)
    at[i] = value_at(lab, unknown, static_cast<double>(i) + 0.5, n), weight[i] /= most;
  const auto& p = c.parameters[unknown];
  report::LineChart chart{.title = p.key,
                          .x_label = with_unit(p.key, p.unit),
                          .y_label = "posterior density over its largest",
                          .curves = {{"posterior", at, weight, report::Mark::line},
                                     {"95 % interval", {p.low, p.high}, {0.02, 0.02}, report::Mark::line}}};
  chart.log_x = lab.unknowns[unknown].scale == study::Scale::log;
  chart.y_from_zero = true;
  return {"marginal-" + p.key, interval_text(p) + ", " + told_in_words(p.told), chart_svg(chart)};
}

report::Figure pair(const Lab& lab, const Calibration& c, std::size_t a, std::size_t b) {
  const std::size_t n = cells_along(std::max<std::size_t>(2, lab.unknowns.size()));
  std::vector<double> weight(n * n, 0.0);
  for (std::size_t i = 0; i < c.posterior.points.size(); ++i)
    weight[cell_of(c.posterior.points[i][b], n) * n + cell_of(c.posterior.points[i][a], n)] +=
        c.posterior.weights[i];
  const double most = *std::max_element(weight.begin(), weight.end());
  report::LineChart chart{.title = fmt::format("{} and {}", c.parameters[a].key, c.parameters[b].key),
                          .x_label = with_unit(c.parameters[a].key, c.parameters[a].unit),
                          .y_label = with_unit(c.parameters[b].key, c.parameters[b].unit)};
  chart.log_x = lab.unknowns[a].scale == study::Scale::log,
  chart.log_y = lab.unknowns[b].scale == study::Scale::log;
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (weight[k] < faint * most) continue;
    const auto i = static_cast<double>(k % n), j = static_cast<double>(k / n);
    chart.patches.push_back({value_at(lab, a, i, n), value_at(lab, a, i + 1.0, n), value_at(lab, b, j, n),
                             value_at(lab, b, j + 1.0, n), weight[k] / most});
  }
  return {fmt::format("pair-{}-{}", a, b), "Darker: more likely, by the measurements together.",
          chart_svg(chart)};
}

report::Figure emulator(const ReadingReport& r) {
  report::Curve runs{.label = "runs left out one at a time", .mark = report::Mark::points};
  double low = 1e300, high = -1e300;
  for (const auto& [run, predicted] : r.left_out) {
    runs.x.push_back(run), runs.y.push_back(predicted);
    low = std::min(low, run), high = std::max(high, run);
  }
  const std::string words = with_unit(words_of(r.result), unit_for_people(r.result));
  report::LineChart chart{.title = fmt::format("Emulator against runs: {}", words_of(r.result)),
                          .x_label = words + " of the run",
                          .y_label = "of the emulator",
                          .curves = {runs, {"equal", {low, high}, {low, high}, report::Mark::line}}};
  return {fmt::format("emulator-{}-{}", r.test, r.result),
          fmt::format("{}: good to {:.2g} {} near the posterior; the measurement to {:.2g}.", r.words,
                      r.emulator_error, unit_for_people(r.result), r.error),
          chart_svg(chart)};
}

report::GridTable fit_table(const Calibration& c) {
  report::GridTable table{"Fit against measurements",
                          {"test", "measured", "± (one standard error)", "best fit", "off by standard errors",
                           "emulator ±", "cells and steps ±"}};
  for (const auto& r : c.readings)
    table.rows.push_back(
        {fmt::format("{}, {}", r.words, with_unit(words_of(r.result), unit_for_people(r.result))),
         fmt::format("{:.4g}", r.measured), fmt::format("{:.2g}", r.error), fmt::format("{:.4g}", r.best_fit),
         fmt::format("{:+.1f}", r.deviation), fmt::format("{:.2g}", r.emulator_error),
         fmt::format("{:.2g}", r.discretisation_error)});
  return table;
}

report::GridTable parameter_table(const Calibration& c) {
  report::GridTable table{"Parameters", {"", "value", "95 % interval", "unit", "by these measurements"}};
  for (const auto& p : c.parameters)
    table.rows.push_back({p.key, fmt::format("{:.4g}", p.value),
                          fmt::format("{:.4g} to {:.4g}", p.low, p.high), p.unit, told_in_words(p.told)});
  return table;
}

report::GridTable forecast_table(const Lab& lab, const Calibration& c) {
  report::GridTable table{"Forecast", {"test", "value", "95 % interval"}};
  for (std::size_t i = 0; i < c.forecasts.size(); ++i) {
    const auto& test = lab.tests[lab.measured + i];
    for (const auto& f : c.forecasts[i])
      table.rows.push_back(
          {fmt::format("{}: {}", test.words, with_unit(words_of(f.result), unit_for_people(f.result))),
           f.value ? person_number(*f.value, f.result) : "–",
           f.value ? fmt::format("{} to {}", person_number(f.low, f.result), person_number(f.high, f.result))
                   : ""});
  }
  return table;
}

report::GridTable advice_table(const Calibration& c, const std::vector<Advice>& advice) {
  report::GridTable table{"What to measure next",
                          {"test", "reading", "expected", "± by the posterior", "± of the test", "bits"}};
  for (const auto& p : c.parameters) table.columns.push_back("interval left, " + p.key);
  for (const auto& a : advice) {
    std::vector<std::string> row{a.test,
                                 with_unit(words_of(a.result), a.unit),
                                 fmt::format("{:.3g}", a.value),
                                 fmt::format("{:.2g}", a.scatter),
                                 fmt::format("{:.2g}", a.error),
                                 fmt::format("{:.1f}", a.bits)};
    for (const double left : a.left) row.push_back(fmt::format("{:.0f} %", 100.0 * left));
    table.rows.push_back(row);
  }
  return table;
}

report::Verdict verdict_of(const Calibration& c) {
  if (c.readings.empty()) return {};
  const auto worst = std::max_element(c.readings.begin(), c.readings.end(), [](const auto& a, const auto& b) {
    return std::abs(a.deviation) < std::abs(b.deviation);
  });
  return {c.reasons.empty() ? report::VerdictKind::agrees : report::VerdictKind::differs,
          fmt::format(
              "{} The farthest off is {} of {}: measured {:.4g}, best fit {:.4g}, {:.1f} standard errors.",
              c.reasons.empty() ? "The model meets the measurements within their errors." : "",
              words_of(worst->result), worst->test, worst->measured, worst->best_fit,
              std::abs(worst->deviation))};
}

void add_figures(const Lab& lab, const Calibration& c, report::Page& page) {
  const std::size_t n = lab.unknowns.size();
  for (std::size_t i = 0; i < n; ++i) page.figures.push_back(marginal(lab, c, i));
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) page.figures.push_back(pair(lab, c, a, b));
  for (const auto& r : c.readings)
    if (r.left_out.size() > 1) page.figures.push_back(emulator(r));
}

}  // namespace

std::string calibration_html(const Lab& lab, const Calibration& c, const std::vector<Advice>& advice,
                             const std::string& input, const std::string& command) {
  report::Page page;
  std::vector<std::string> values;
  for (const auto& p : c.parameters) values.push_back(fmt::format("{} {}", p.key, interval_text(p)));
  page.headline = fmt::format("{}: {}", lab.name, fmt::join(values, ", "));
  page.title = "Tremie: " + page.headline;
  page.verdict = verdict_of(c);
  page.trust = {c.reasons.empty(),
                fmt::format("Intervals hold 95 % of the posterior; the error of measurements, emulators, "
                            "cells and steps is in them, that of the model is not. {} runs of each test.",
                            c.trials.size()),
                c.reasons};
  add_figures(lab, c, page);
  page.grids = {parameter_table(c), fit_table(c)};
  if (auto forecasts = forecast_table(lab, c); !forecasts.rows.empty()) page.grids.push_back(forecasts);
  if (!advice.empty()) page.grids.push_back(advice_table(c, advice));
  page.words = {"Emulator: a Gaussian process through the runs, which stands for a run in the likelihood.",
                "Off by standard errors: measured less best fit, over the errors of both together."};
  if (!advice.empty())
    page.words.push_back(
        "Bits: the information that a test is expected to give; one halves the range of what is possible. "
        "Interval left: of the interval that a parameter has now.");
  page.made = report::facts_of_this_run(command);
  page.scene = input, page.scene_words = "The laboratory's file";
  return to_html(page);
}

}  // namespace tremie::calibration
