#include "apparatus/cli/study/fit_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Stress and rate at the vane, where both parameters are told.
void add_flow_curve(const FitResult& r, const Instrument& in, report::FitReport& report) {
  if (r.kind != RecordKind::flow_curve || !r.tau_0 || !r.mu || !(r.mu->value > 0.0)) return;
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    const double stress = shear_stress_at(in.vane_radius, r.curve.fitted[i], in);
    report.stress_fitted.push_back(stress);
    report.stress_observed.push_back(shear_stress_at(in.vane_radius, r.curve.observed[i], in));
    report.rate.push_back(std::max(0.0, (stress - r.tau_0->value) / r.mu->value));
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

}  // namespace

report::FitReport fit_report(const FitResult& r, const Instrument& in, const std::string& record,
                             const std::string& command) {
  report::FitReport report;
  report.record = record, report.command = command;
  report.decay = r.kind == RecordKind::torque_decay;
  report.parameters = {parameter("dynamic yield stress", "Pa", "yield_stress_Pa", r.tau_0),
                       parameter("plastic viscosity", "Pa·s", "plastic_viscosity_Pa_s", r.mu)};
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
  add_flow_curve(r, in, report);
  add_flocculation(r, report);
  report.scatter = r.scatter, report.correlation = r.correlation;
  report.readings = r.readings, report.dropped = r.dropped_count;
  report.notes = r.notes, report.reasons = r.reasons;
  return report;
}

}  // namespace tremie::cli
