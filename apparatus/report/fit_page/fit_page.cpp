#include "apparatus/report/fit_page/fit_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "rheometer/fits/flow_law.hpp"

namespace tremie::report {
namespace {

bool is_decay(const FitResult& fit) { return fit.kind == RecordKind::torque_decay; }

std::string line_of(const FitResult& fit) {
  const FlowLaw* law = law_of(fit);
  return law                            ? law->line
         : fit.model == interface_model ? "interface law at the cylinder"
                                        : "thixotropic Couette model";
}

std::string value_text(const std::optional<ParameterEstimate>& e) {
  if (!e) return "not identifiable from this record";
  return e->given ? scene::rounded(e->value, 4) + " (given)" : with_interval(*e, 4);
}

/// A pure number of a law goes by its symbol too: "flow index n".
std::string words_of(const FitParameter& p) {
  return !p.member && p.unit.empty() ? p.words + " " + p.symbol : p.words;
}

/// The fitted parameters of a flow curve's law in their order; empty where the record does not tell all of them.
std::vector<double> values_of_law(const FitResult& fit) {
  std::vector<double> values;
  if (const FlowLaw* law = law_of(fit))
    for (const LawParameter& p : law->parameters) {
      const auto value = value_of(fit, p.row);
      if (!value) return {};
      values.push_back(value->value);
    }
  return values;
}

/// The 95 % band of a fitted line that is the fitted torque times a constant, where its error is known.
std::vector<Band> band_of(const FitResult& fit, const std::vector<double>& x,
                          const std::vector<double>& line) {
  const FittedCurve& curve = fit.curve;
  if (is_decay(fit) || curve.standard_error.size() != line.size()) return {};
  Band band{"95 % band of the fitted line", x, line, line};
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double half = 1.96 * curve.standard_error[i] / curve.fitted[i] * line[i];
    band.low[i] -= half, band.high[i] += half;
  }
  return {band};
}

/// The fitted torque: at many speeds from just above 0 on where the record tells a plastic viscosity, else at the readings.
Curve fitted_torque(const FitResult& fit, const Instrument& in) {
  const FlowLaw* law = law_of(fit);
  const std::vector<double> values = values_of_law(fit);
  Curve line{line_of(fit), {}, {}};
  constexpr int pieces = 100;
  if (!values.empty() && fit.mu && fit.mu->value > 0.0 && !fit.curve.x.empty())
    for (int i = 0; i <= pieces; ++i) {
      const double omega = fit.curve.x.back() * (i + 0.01) / pieces;
      line.x.push_back(omega / shown_units(fit.sheared_evenly).speed);
      line.y.push_back(law->torque(values, omega, in).torque);
    }
  else
    line.x = shown_x(fit), line.y = fit.curve.fitted;
  return line;
}

LineChart torque_chart(const FitResult& fit, const Instrument& in) {
  const std::vector<double> x = shown_x(fit);
  LineChart chart{.title = is_decay(fit)        ? "Decay of the torque"
                           : fit.sheared_evenly ? "Flow curve"
                                                : "Torque over speed",
                  .x_label = x_label(fit),
                  .y_label = y_label(fit),
                  .curves = {{"readings", x, fit.curve.observed, Mark::points}, fitted_torque(fit, in)},
                  .bands = band_of(fit, x, fit.curve.fitted)};
  if (fit.plug_below) {
    const double plug_below = *fit.plug_below / two_pi;
    chart.ranges = {{fmt::format("plug below {:.3g} rev/s", plug_below), 0.0, plug_below}};
  }
  return chart;
}

/// "fitted line: 54.1 Pa, 35.6 Pa·s".
std::string line_label(const FitResult& fit) {
  std::string text = "fitted line";
  for (const FitParameter& p : parameters_of(fit))
    if (const auto e = value_of(fit, p))
      text += fmt::format("{}{}{}{}", text.ends_with("line") ? ": " : ", ", scene::rounded(e->value, 4),
                          p.unit.empty() ? "" : " ", unit_on_page(p));
  return text;
}

/// Stress and rate at the vane, where all parameters of the law are identifiable.
LineChart flow_curve_chart(const FitResult& fit, const Instrument& in) {
  const FlowLaw* law = law_of(fit);
  const std::vector<double> values = values_of_law(fit);
  if (values.empty() || fit.sheared_evenly) return {};
  std::vector<double> rates, observed, fitted;
  for (std::size_t i = 0; i < fit.curve.x.size(); ++i) {
    const double stress = shear_stress_at(in.vane_radius, fit.curve.fitted[i], in);
    const auto rate = law->rate(values, std::max(0.0, stress - values[0]));
    if (!rate) return {};
    rates.push_back(*rate);
    fitted.push_back(stress);
    observed.push_back(shear_stress_at(in.vane_radius, fit.curve.observed[i], in));
  }
  return {.title = "Flow curve",
          .x_label = "shear rate at the vane (1/s)",
          .y_label = "shear stress at the vane (Pa)",
          .curves = {{"readings", rates, observed, Mark::points}, {line_label(fit), rates, fitted}},
          .bands = band_of(fit, rates, fitted)};
}

/// The apparent flocculation state and the exponential through it, by the whole window's coefficient.
LineChart flocculation_chart(const FitResult& fit) {
  const std::vector<double>&t = fit.curve.x, &lambda = fit.lambda_apparent;
  if (!fit.apparent || fit.apparent->windows.empty() || lambda.size() != t.size()) return {};
  const double coefficient = fit.apparent->windows.back().coefficient;
  double log_sum = 0.0, n = 0.0;  // its factor: mean of ln(lambda) + c t
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!(lambda[i] > 0.0)) continue;
    log_sum += std::log(lambda[i]) + coefficient * t[i];
    n += 1.0;
  }
  if (n < 2.0) return {};
  Curve line{"exponential through it", t, {}};
  for (const double time : t) line.y.push_back(std::exp(log_sum / n - coefficient * time));
  line.label +=
      fmt::format(", {:.3g} 1/s", std::log(line.y.front() / line.y.back()) / (t.back() - t.front()));
  return {.title = "Flocculation state λ, as read off the torque",
          .x_label = x_label(fit),
          .y_label = "apparent λ",
          .curves = {{"from the torque", t, lambda, Mark::points}, line}};
}

LineChart residual_chart(const FitResult& fit) {
  Curve residuals{.label = "", .x = shown_x(fit), .y = {}, .mark = Mark::points};
  for (std::size_t i = 0; i < fit.curve.x.size(); ++i)
    residuals.y.push_back(100.0 * (fit.curve.observed[i] / fit.curve.fitted[i] - 1.0));
  return {.title = "Residuals",
          .x_label = x_label(fit),
          .y_label = "reading less fit (% of the fit)",
          .curves = {residuals},
          .levels = {{"no residual", 0.0, 0.0}}};
}

struct FitChart {
  const char *name, *caption;
  LineChart chart;
};

/// All that can be drawn.
std::vector<FitChart> charts_of(const FitResult& fit, const Instrument& in) {
  std::vector<FitChart> charts{
      {"torque", "", torque_chart(fit, in)},
      {"flow_curve", "The rate of a reading is the fitted model's at its torque.", flow_curve_chart(fit, in)},
      {"flocculation", "", flocculation_chart(fit)},
      {"residuals", "Without a pattern where the model fits.", residual_chart(fit)}};
  std::erase_if(charts, [](const FitChart& c) { return !can_be_drawn(c.chart); });
  return charts;
}

/// "left out: 2 (before the torque's peak), 1 (no torque)".
std::string left_out(const FitResult& fit) {
  std::vector<std::string> parts;
  for (const auto& [reason, rows] : fit.dropped_reasons)
    parts.push_back(fmt::format("{} ({})", rows, reason));
  if (parts.empty()) return "none is left out";
  return fmt::format("left out: {}", fmt::join(parts, ", "));
}

std::string trust_text(const FitResult& fit) {
  const bool pattern = std::abs(fit.correlation) >= 0.3 && fit.readings > 10;
  return fmt::format(
      "{} readings are used; {}. Those used scatter by {:.2g} % about the fitted line{} "
      "Intervals "
      "hold 95 %.",
      fit.readings, left_out(fit), 100.0 * fit.scatter,
      pattern ? fmt::format(", and successive residuals are correlated ({:.2f}): the model may miss an "
                            "effect of this size, or the record is smoothed.",
                            fit.correlation)
              : ".");
}

std::string headline(const FitResult& fit, const std::string& record) {
  std::string text;
  for (const FitParameter& p : parameters_of(fit)) {
    const auto e = value_of(fit, p);
    if (!e || e->given) continue;
    text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", words_of(p), scene::rounded(e->value, 3),
                        p.unit.empty() ? "" : " ", unit_on_page(p));
  }
  const std::string file = std::filesystem::path(record).filename().string();
  const char* kind = is_decay(fit)                  ? "a torque decay"
                     : fit.model == interface_model ? "a tribometer's torques"
                                                    : "a flow curve";
  return fmt::format("{}, {}: {}", file, kind, text.empty() ? "tells no parameter" : text);
}

Verdict verdict_of(const FitResult& fit) {
  if (!fit.reasons.empty())
    return {VerdictKind::differs, "The model does not fit the record, or its parameters cannot be trusted."};
  if (fit.law_in_doubt)
    return {VerdictKind::none,
            "Another law describes the record far better and has another yield stress: see the note below."};
  return {VerdictKind::agrees, "The model fits the record."};
}

}  // namespace

std::vector<double> shown_x(const FitResult& fit) {
  std::vector<double> x = fit.curve.x;
  if (!is_decay(fit))
    for (double& speed : x) speed /= shown_units(fit.sheared_evenly).speed;
  return x;
}

std::string x_label(const FitResult& fit) {
  return is_decay(fit) ? "time (s)" : shown_units(fit.sheared_evenly).speed_label;
}

std::string y_label(const FitResult& fit) { return shown_units(fit.sheared_evenly).torque_label; }

std::string with_interval(const ParameterEstimate& e, int digits) {
  const std::string text = scene::rounded(e.value, digits);
  return e.ci95 ? fmt::format("{} ({} to {})", text, scene::rounded(e.ci95->low, digits),
                              scene::rounded(e.ci95->high, digits))
                : text + " (no interval)";
}

std::string unit_on_page(const FitParameter& p) {
  return p.unit == "Pa s" ? "Pa·s" : p.unit == "Pa s^n" ? "Pa·sⁿ" : p.unit == "Pa s/m" ? "Pa·s/m" : p.unit;
}

std::string fit_html(const FitResult& fit, const Instrument& instrument, const std::string& record,
                     const std::string& command) {
  Page page;
  page.headline = headline(fit, record);
  page.title = "Tremie: " + page.headline;
  page.verdict = verdict_of(fit);
  page.trust = {fit.reasons.empty(), trust_text(fit), fit.reasons};
  for (const auto& [name, caption, chart] : charts_of(fit, instrument))
    page.figures.push_back({name, caption, chart_svg(chart)});
  ValueTable table{"Parameters, with their 95 % intervals", {}};
  for (const FitParameter& p : parameters_of(fit)) {
    const auto e = value_of(fit, p);
    table.rows.push_back({words_of(p), value_text(e), e ? unit_on_page(p) : "", p.key});
  }
  page.numbers = {table};
  page.remarks = fit.notes;
  page.words = {"λ, the flocculation state: the yield stress is (1 + λ) times the dynamic one.",
                "α: how fast shear breaks λ down; A_thix: how fast rest builds the yield stress up."};
  page.made = facts_of_this_run(command);
  return to_html(page);
}

std::vector<std::pair<std::string, std::string>> fit_chart_files(const FitResult& fit,
                                                                 const Instrument& instrument) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& [name, caption, chart] : charts_of(fit, instrument))
    files.emplace_back(std::string(name) + ".svg", svg_file({chart}));
  return files;
}

}  // namespace tremie::report
