#include "apparatus/report/fit_page/fit_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::report {
namespace {

std::string value_text(const FitParameter& p) {
  if (!p.value) return "not told by this record";
  const std::string text = scene::rounded(*p.value, 4);
  if (p.given) return text + " (given)";
  return p.low && p.high
             ? fmt::format("{} ({} to {})", text, scene::rounded(*p.low, 4), scene::rounded(*p.high, 4))
             : text + " (no interval)";
}

std::string x_label(const FitReport& fit) { return fit.decay ? "time (s)" : "speed (rev/s)"; }

/// The 95 % band of a fitted line that is the fitted torque times a constant, where its error is known.
std::vector<Band> band_of(const FitReport& fit, const std::vector<double>& x,
                          const std::vector<double>& line) {
  if (fit.standard_error.size() != line.size()) return {};
  Band band{"95 % band of the fitted line", x, line, line};
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double half = 1.96 * fit.standard_error[i] / fit.fitted[i] * line[i];
    band.low[i] -= half, band.high[i] += half;
  }
  return {band};
}

/// "fitted line: 54.1 Pa, 35.6 Pa·s".
std::string line_label(const FitReport& fit) {
  std::string text = "fitted line";
  for (const FitParameter& p : fit.parameters)
    if (p.value)
      text += fmt::format("{}{}{}{}", text.ends_with("line") ? ": " : ", ", scene::rounded(*p.value, 4),
                          p.unit.empty() ? "" : " ", p.unit);
  return text;
}

LineChart torque_chart(const FitReport& fit) {
  const bool own_line = !fit.line.empty();
  LineChart chart{.title = fit.decay ? "Decay of the torque" : "Torque over speed",
                  .x_label = x_label(fit),
                  .y_label = "torque (N·m)",
                  .curves = {{"readings", fit.x, fit.observed, Mark::points},
                             {fit.model, own_line ? fit.line_x : fit.x, own_line ? fit.line : fit.fitted}},
                  .bands = band_of(fit, fit.x, fit.fitted)};
  if (fit.plug_below)
    chart.ranges = {{fmt::format("plug below {:.3g} rev/s", *fit.plug_below), 0.0, *fit.plug_below}};
  return chart;
}

LineChart flow_curve_chart(const FitReport& fit) {
  return {.title = "Flow curve",
          .x_label = "shear rate at the vane (1/s)",
          .y_label = "shear stress at the vane (Pa)",
          .curves = {{"readings", fit.rate, fit.stress_observed, Mark::points},
                     {line_label(fit), fit.rate, fit.stress_fitted}},
          .bands = band_of(fit, fit.rate, fit.stress_fitted)};
}

LineChart flocculation_chart(const FitReport& fit) {
  std::string label = "exponential through it";
  if (fit.lambda_line.size() > 1)
    label += fmt::format(", {:.3g} 1/s", std::log(fit.lambda_line.front() / fit.lambda_line.back()) /
                                             (fit.x.back() - fit.x.front()));
  return {.title = "Flocculation state λ, as read off the torque",
          .x_label = x_label(fit),
          .y_label = "apparent λ",
          .curves = {{"from the torque", fit.x, fit.lambda_apparent, Mark::points},
                     {label, fit.x, fit.lambda_line}}};
}

LineChart residual_chart(const FitReport& fit) {
  Curve residuals{.label = "", .x = fit.x, .y = {}, .mark = Mark::points};
  for (std::size_t i = 0; i < fit.x.size(); ++i)
    residuals.y.push_back(100.0 * (fit.observed[i] / fit.fitted[i] - 1.0));
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
std::vector<FitChart> charts_of(const FitReport& fit) {
  std::vector<FitChart> charts{
      {"torque", "", torque_chart(fit)},
      {"flow_curve", "The rate of a reading is the fitted model's at its torque.", flow_curve_chart(fit)},
      {"flocculation", "", flocculation_chart(fit)},
      {"residuals", "Without a pattern where the model fits.", residual_chart(fit)}};
  std::erase_if(charts, [](const FitChart& c) { return !can_be_drawn(c.chart); });
  return charts;
}

/// "left out: 2 (before the torque's peak), 1 (no torque)".
std::string left_out(const FitReport& fit) {
  std::vector<std::string> parts;
  for (const auto& [reason, rows] : fit.dropped) parts.push_back(fmt::format("{} ({})", rows, reason));
  if (parts.empty()) return "none is left out";
  return fmt::format("left out: {}", fmt::join(parts, ", "));
}

std::string trust_text(const FitReport& fit) {
  const bool pattern = std::abs(fit.correlation) >= 0.3 && fit.readings > 10;
  return fmt::format(
      "{} readings are used; {}. Those used scatter by {:.2g} % about the fitted line{} "
      "Intervals "
      "hold 95 %.",
      fit.readings, left_out(fit), 100.0 * fit.scatter,
      pattern ? fmt::format(
                    ", and successive ones go together (correlation {:.2f}): to that size the model leaves "
                    "something out, or the record is smoothed.",
                    fit.correlation)
              : ".");
}

std::string headline(const FitReport& fit) {
  std::string text;
  for (const FitParameter& p : fit.parameters) {
    if (!p.value || p.given) continue;
    text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", p.words, scene::rounded(*p.value, 3),
                        p.unit.empty() ? "" : " ", p.unit);
  }
  const std::string file = std::filesystem::path(fit.record).filename().string();
  return fmt::format("{}, {}: {}", file, fit.decay ? "a torque decay" : "a flow curve",
                     text.empty() ? "tells no parameter" : text);
}

Verdict verdict_of(const FitReport& fit) {
  if (!fit.reasons.empty())
    return {VerdictKind::differs, "The model does not fit the record, or its parameters cannot be trusted."};
  if (fit.law_in_doubt)
    return {VerdictKind::none,
            "Another law describes the record far better and has another yield stress: see the note below."};
  return {VerdictKind::agrees, "The model fits the record."};
}

}  // namespace

std::string fit_html(const FitReport& fit) {
  Page page;
  page.headline = headline(fit);
  page.title = "Tremie: " + page.headline;
  page.verdict = verdict_of(fit);
  page.trust = {fit.reasons.empty(), trust_text(fit), fit.reasons};
  for (const auto& [name, caption, chart] : charts_of(fit))
    page.figures.push_back({name, caption, chart_svg(chart)});
  ValueTable table{"Parameters, with their 95 % intervals", {}};
  for (const FitParameter& p : fit.parameters)
    table.rows.push_back({p.words, value_text(p), p.value ? p.unit : "", p.key});
  page.numbers = {table};
  page.remarks = fit.notes;
  page.words = {"λ, the flocculation state: the yield stress is (1 + λ) times the dynamic one.",
                "α: how fast shear breaks λ down; A_thix: how fast rest builds the yield stress up."};
  page.made = facts_of_this_run(fit.command);
  return to_html(page);
}

std::vector<std::pair<std::string, std::string>> fit_chart_files(const FitReport& fit) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& [name, caption, chart] : charts_of(fit))
    files.emplace_back(std::string(name) + ".svg", svg_file({chart}));
  return files;
}

}  // namespace tremie::report
