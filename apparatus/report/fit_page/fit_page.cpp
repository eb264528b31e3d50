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
  return law ? law->line : "thixotropic Couette model";
}

std::string value_text(const std::optional<Estimate>& e) {
  if (!e) return "not told by this record";
  const std::string text = scene::rounded(e->value, 4);
  if (e->given) return text + " (given)";
  return e->ci95 ? fmt::format("{} ({} to {})", text, scene::rounded(e->ci95->low, 4),
                               scene::rounded(e->ci95->high, 4))
                 : text + " (no interval)";
}

/// A pure number of a law goes by its symbol too: "flow index n".
std::string words_of(const FitParameter& p) {
  return !p.member && p.unit.empty() ? p.words + " " + p.symbol : p.words;
}

/// The 95 % band of the fitted torque, where its error is known.
std::vector<Band> band_of(const FitResult& fit) {
  const FittedCurve& curve = fit.curve;
  if (is_decay(fit) || curve.standard_error.size() != curve.x.size()) return {};
  Band band{"95 % band of the fitted line", shown_x(fit), curve.fitted, curve.fitted};
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    band.low[i] -= 1.96 * curve.standard_error[i], band.high[i] += 1.96 * curve.standard_error[i];
  return {band};
}

void add(const LineChart& chart, const char* id, const std::string& caption, Page& page) {
  if (can_be_drawn(chart)) page.figures.push_back({id, caption, chart_svg(chart)});
}

void add_torque(const FitResult& fit, Page& page) {
  const std::vector<double> x = shown_x(fit);
  const LineChart chart{
      .title = is_decay(fit) ? "Decay of the torque" : "Torque over speed",
      .x_label = x_label(fit),
      .y_label = "torque (N·m)",
      .curves = {{"readings", x, fit.curve.observed, Mark::points}, {line_of(fit), x, fit.curve.fitted}},
      .bands = band_of(fit)};
  add(chart, "torque", "", page);
}

/// Stress and rate at the vane, where all parameters of the law are identifiable.
void add_flow_curve(const FitResult& fit, const Instrument& in, Page& page) {
  const FlowLaw* law = law_of(fit);
  if (!law) return;
  std::vector<double> parameters, rates, observed, fitted;
  for (const LawParameter& p : law->parameters) {
    const auto value = value_of(fit, p.row);
    if (!value) return;
    parameters.push_back(value->value);
  }
  for (std::size_t i = 0; i < fit.curve.x.size(); ++i) {
    const double stress = shear_stress_at(in.vane_radius, fit.curve.fitted[i], in);
    const auto rate = law->rate(parameters, std::max(0.0, stress - parameters[0]));
    if (!rate) return;
    rates.push_back(*rate);
    fitted.push_back(stress);
    observed.push_back(shear_stress_at(in.vane_radius, fit.curve.observed[i], in));
  }
  if (rates.empty()) return;
  const LineChart chart{
      .title = "Flow curve",
      .x_label = "shear rate at the vane (1/s)",
      .y_label = "shear stress at the vane (Pa)",
      .curves = {{"readings", rates, observed, Mark::points}, {"fitted line", rates, fitted}}};
  add(chart, "flow_curve", "The rate of a reading is the fitted model's at its torque.", page);
}

/// The apparent flocculation state and the exponential through it, by the whole window's coefficient.
void add_flocculation(const FitResult& fit, Page& page) {
  const std::vector<double>&t = fit.curve.x, &lambda = fit.lambda_apparent;
  if (!fit.apparent || fit.apparent->windows.empty() || lambda.size() != t.size()) return;
  const double coefficient = fit.apparent->windows.back().coefficient;
  double log_sum = 0.0, n = 0.0;  // its factor: mean of ln(lambda) + c t
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!(lambda[i] > 0.0)) continue;
    log_sum += std::log(lambda[i]) + coefficient * t[i];
    n += 1.0;
  }
  if (n < 2.0) return;
  std::vector<double> line;
  for (const double time : t) line.push_back(std::exp(log_sum / n - coefficient * time));
  const LineChart chart{
      .title = "Flocculation state λ, as read off the torque",
      .x_label = x_label(fit),
      .y_label = "apparent λ",
      .curves = {{"from the torque", t, lambda, Mark::points}, {"exponential through it", t, line}}};
  add(chart, "flocculation", "", page);
}

void add_residuals(const FitResult& fit, Page& page) {
  Curve residuals{.label = "", .x = shown_x(fit), .y = {}, .mark = Mark::points};
  for (std::size_t i = 0; i < fit.curve.x.size(); ++i)
    residuals.y.push_back(100.0 * (fit.curve.observed[i] / fit.curve.fitted[i] - 1.0));
  const LineChart chart{.title = "Residuals",
                        .x_label = x_label(fit),
                        .y_label = "reading less fit (% of the fit)",
                        .curves = {residuals},
                        .levels = {{"no residual", 0.0, 0.0}}};
  add(chart, "residuals", "Without a pattern where the model fits.", page);
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
      pattern ? fmt::format(
                    ", and successive ones go together (correlation {:.2f}): to that size the model leaves "
                    "something out, or the record is smoothed.",
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
  return fmt::format("{}, {}: {}", file, is_decay(fit) ? "a torque decay" : "a flow curve",
                     text.empty() ? "tells no parameter" : text);
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
    for (double& speed : x) speed /= two_pi;
  return x;
}

std::string x_label(const FitResult& fit) { return is_decay(fit) ? "time (s)" : "speed (rev/s)"; }

std::string unit_on_page(const FitParameter& p) {
  return p.unit == "Pa s" ? "Pa·s" : p.unit == "Pa s^n" ? "Pa·sⁿ" : p.unit;
}

std::string fit_html(const FitResult& fit, const Instrument& instrument, const std::string& record,
                     const std::string& command) {
  Page page;
  page.headline = headline(fit, record);
  page.title = "Tremie: " + page.headline;
  page.verdict = verdict_of(fit);
  page.trust = {fit.reasons.empty(), trust_text(fit), fit.reasons};
  add_torque(fit, page);
  add_flow_curve(fit, instrument, page);
  add_flocculation(fit, page);
  add_residuals(fit, page);
  NumberTable table{"Parameters, with their 95 % intervals", {}};
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

}  // namespace tremie::report
