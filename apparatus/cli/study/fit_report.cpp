#include "apparatus/cli/study/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

namespace tremie::cli {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

report::FitParameter parameter(const char* words, const char* unit, const char* key,
                               const std::optional<Estimate>& e) {
  report::FitParameter p{words, unit, key, {}, {}, {}, false};
  if (!e) return p;
  p.value = e->value, p.given = e->given;
  if (e->ci95) p.low = e->ci95->low, p.high = e->ci95->high;
  return p;
}

/// The rate at which the fitted fluid has a stress; empty where the record does not tell its parameters.
std::optional<double> rate_at(const FitResult& r, double stress) {
  if (!r.tau_0) return std::nullopt;
  const double above = std::max(0.0, stress - r.tau_0->value);
  if (r.mu && r.mu->value > 0.0) return above / r.mu->value;
  if (!r.consistency || !r.flow_index || !(r.consistency->value > 0.0)) return std::nullopt;
  return std::pow(above / r.consistency->value, 1.0 / r.flow_index->value);
}

/// Stress and rate at the vane, where all parameters are told.
void add_flow_curve(const FitResult& r, const Instrument& in, report::FitReport& report) {
  if (r.kind != RecordKind::flow_curve) return;
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    const double stress = shear_stress_at(in.vane_radius, r.curve.fitted[i], in);
    const auto rate = rate_at(r, stress);
    if (!rate) return;
    report.stress_fitted.push_back(stress);
    report.stress_observed.push_back(shear_stress_at(in.vane_radius, r.curve.observed[i], in));
    report.rate.push_back(*rate);
  }
}

/// The fitted torque at many speeds from just above 0 on, where the record tells Bingham's parameters.
void add_line(const FitResult& r, const Instrument& in, report::FitReport& report) {
  if (r.kind != RecordKind::flow_curve || !r.tau_0 || !r.mu || !(r.mu->value > 0.0) || r.curve.x.empty())
    return;
  constexpr int pieces = 100;
  for (int i = 0; i <= pieces; ++i) {
    const double omega = r.curve.x.back() * (i + 0.01) / pieces;
    report.line_x.push_back(omega / two_pi);
    report.line.push_back(reiner_riwlin({r.tau_0->value, r.mu->value}, omega, in).torque);
  }
}

/// The exponential through the apparent flocculation state, by the whole window's coefficient.
void add_flocculation(const FitResult& r, report::FitReport& report) {
  if (!r.apparent || r.apparent->windows.empty() || r.lambda_apparent.size() != r.curve.x.size()) return;
  const double coefficient = r.apparent->windows.back().coefficient;
  double log_sum = 0.0, n = 0.0;  // its factor: mean of ln(lambda) + c t
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    if (!(r.lambda_apparent[i] > 0.0)) continue;
    log_sum += std::log(r.lambda_apparent[i]) + coefficient * r.curve.x[i];
    n += 1.0;
  }
  if (n < 2.0) return;
  report.lambda_apparent = r.lambda_apparent;
  for (const double t : r.curve.x) report.lambda_line.push_back(std::exp(log_sum / n - coefficient * t));
}

std::string words_of(const std::string& name) {
  static const std::map<std::string, std::string> words{{"yield_stress", "dynamic yield stress"},
                                                        {"flocculation_start", "λ at the start"},
                                                        {"alpha", "α"},
                                                        {"exponent", "exponent of the kinetics"},
                                                        {"structuration_rate", "A_thix"}};
  if (const auto known = words.find(name); known != words.end()) return known->second;
  std::string text = name;
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string unit_of(const std::string& unit) {
  return unit == "Pa s" ? "Pa·s" : unit == "Pa s^n" ? "Pa·sⁿ" : unit;
}

}  // namespace

report::FitReport fit_report(const FitResult& r, const Instrument& in, const std::string& record,
                             const std::string& command) {
  report::FitReport report;
  report.record = record, report.command = command;
  report.decay = r.kind == RecordKind::torque_decay;
  report.model = report.decay                    ? "thixotropic Couette model"
                 : r.model == "herschel_bulkley" ? "Herschel-Bulkley in the gap"
                                                 : "Reiner-Riwlin";
  report.parameters = {parameter("dynamic yield stress", "Pa", "yield_stress_Pa", r.tau_0),
                       parameter("plastic viscosity", "Pa·s", "plastic_viscosity_Pa_s", r.mu)};
  if (r.model == "herschel_bulkley")
    report.parameters = {report.parameters.front(),
                         parameter("consistency", "Pa·sⁿ", "consistency_Pa_s_n", r.consistency),
                         parameter("flow index n", "", "flow_index", r.flow_index)};
  if (report.decay) {
    report.parameters.push_back(
        parameter("static yield stress", "Pa", "static_yield_stress_Pa", r.static_yield_stress));
    report.parameters.push_back(parameter("λ at the start", "", "flocculation_start", r.lambda_0));
    report.parameters.push_back(parameter("α", "", "alpha", r.alpha));
    report.parameters.push_back(parameter("A_thix", "Pa/s", "structuration_rate_Pa_per_s", r.A_thix));
  }
  report.x = r.curve.x, report.observed = r.curve.observed, report.fitted = r.curve.fitted;
  if (!report.decay)
    for (double& x : report.x) x /= two_pi;
  if (!report.decay) report.standard_error = r.curve.standard_error;
  if (r.plug_below) report.plug_below = *r.plug_below / two_pi;
  add_line(r, in, report);
  add_flow_curve(r, in, report);
  add_flocculation(r, report);
  report.scatter = r.scatter, report.correlation = r.correlation;
  report.readings = r.readings, report.dropped = r.dropped_reasons;
  report.notes = r.notes, report.reasons = r.reasons, report.law_in_doubt = r.law_in_doubt;
  return report;
}

report::ReplicatesReport replicates_report(const std::vector<FitResult>& fits,
                                           const std::vector<ReplicateMean>& means,
                                           std::vector<report::FitReport> reports,
                                           const std::string& command) {
  report::ReplicatesReport r{std::move(reports), {}, {}, command};
  for (const ReplicateMean& m : means) {
    report::MeanParameter p{
        .words = words_of(m.name), .unit = unit_of(m.unit), .key = m.name, .mean = m.mean.value};
    if (m.mean.ci95) p.low = m.mean.ci95->low, p.high = m.mean.ci95->high;
    p.records = m.records, p.between = m.between, p.within = m.within, p.laboratories = m.laboratories;
    for (const FitResult& f : fits) {
      const auto& e = value_of(f, m);
      p.values.push_back(e && !e->given ? std::optional(e->value) : std::nullopt);
    }
    r.means.push_back(std::move(p));
  }
  for (std::size_t i = 0; i < fits.size(); ++i)
    for (const auto& why : fits[i].reasons) r.reasons.push_back(r.fits[i].record + ": " + why);
  return r;
}

}  // namespace tremie::cli
