#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "rheometer/fits/fit_common.hpp"
#include "rheometer/regression/statistics.hpp"

namespace tremie::fitting {

namespace {

constexpr std::size_t most_readings = 2000;

Readings readings_of(const TorqueRecord& record, FitResult& result) {
  std::vector<std::size_t> order(record.torque.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return record.omega[a] < record.omega[b]; });
  Readings all;
  for (const std::size_t i : order) {
    if (record.omega[i] <= 0.0)
      drop(result, record.line[i], record.omega[i], record.torque[i],
           "no speed: not a point of the flow curve");
    else if (record.torque[i] <= 0.0)
      drop(result, record.line[i], record.omega[i], record.torque[i], "no torque");
    else
      all.push(record.omega[i], record.torque[i], 1.0, record.line[i]);
  }
  return condense(all, most_readings, result);
}

bool several_speeds(const Readings& r) { return r.size() >= 2 && r.x.back() > r.x.front() * (1.0 + 1e-9); }

struct Fitted {
  Bingham bingham;
  LeastSquaresFit fit;
};

/// tau_0 and mu, or the one of them that is not given.
Fitted least_squares(const Readings& r, const FitInput& input) {
  std::vector<FlowPoint> points;
  for (std::size_t i = 0; i < r.size(); ++i) points.push_back({r.x[i], r.torque[i]});
  const Bingham start = bingham_from_flow_curve(points, input.instrument);
  const bool fit_tau_0 = !input.tau_0, fit_mu = !input.mu;
  const auto bingham = [&](std::span<const double> p) {
    return Bingham{fit_tau_0 ? p.front() : *input.tau_0, fit_mu ? p.back() : *input.mu};
  };

  LeastSquaresProblem problem;
  problem.observed = r.torque;
  problem.count = r.count;
  if (fit_tau_0) problem.start.push_back(start.tau_0);
  if (fit_mu) problem.start.push_back(start.mu);
  problem.lower.assign(problem.start.size(), 0.0);
  problem.upper.assign(problem.start.size(), 1e9);
  problem.model = [&](std::span<const double> p, std::span<double> fitted, std::span<double> jacobian) {
    for (std::size_t i = 0, at = 0; i < r.size(); ++i) {
      const CouetteState s = reiner_riwlin(bingham(p), r.x[i], input.instrument);
      fitted[i] = s.torque;
      if (jacobian.empty()) continue;
      if (fit_tau_0) jacobian[at++] = s.d_torque_d_tau_0;
      if (fit_mu) jacobian[at++] = s.d_torque_d_mu;
    }
    return std::all_of(fitted.begin(), fitted.end(), [](double t) { return t > 0.0; });
  };
  LeastSquaresFit fit = fit_least_squares(problem);
  return {bingham(fit.parameters), std::move(fit)};
}

/// How many of the slowest readings lie on a branch where the torque rises as the speed falls, by more than
/// scatter: structure builds up there faster than the shear breaks it, and no Bingham material does that.
std::size_t below_torque_minimum(const Readings& r, const FitInput& input) {
  const auto lowest = std::min_element(r.torque.begin(), r.torque.end()) - r.torque.begin();
  const auto first = static_cast<std::size_t>(lowest);
  std::vector<char> slow(r.size(), 0);
  for (std::size_t i = 0; i < first; ++i) slow[i] = r.x[i] < r.x[first];
  const Readings fast = without(r, slow);
  if (fast.size() == r.size() || fast.size() < 3 || !several_speeds(fast)) return 0;
  const Fitted f = least_squares(fast, input);
  if (f.fit.degrees_of_freedom < 1.0) return 0;
  // the one-in-a-thousand point of a new reading, with a fifth for the uncertainty of the curve
  const double cut = 1.2 * student_quantile(0.999, f.fit.degrees_of_freedom) * std::max(f.fit.scatter, 1e-6);
  for (std::size_t i = first; i-- > 0;) {
    const double expected = reiner_riwlin(f.bingham, r.x[i], input.instrument).torque;
    if (slow[i] && std::sqrt(r.count[i]) * (r.torque[i] / expected - 1.0) > cut) return i + 1;
  }
  return 0;
}

void report_plug(const Readings& r, const Bingham& b, const FitInput& input, FitResult& result) {
  const double ratio = input.instrument.container_radius / input.instrument.vane_radius;
  const CouetteState slowest = reiner_riwlin(b, r.x.front(), input.instrument);
  result.plug = slowest.plug;
  result.sheared_radius = slowest.sheared_radius;
  if (b.tau_0 > 0.0 && b.mu > 0.0)
    result.plug_below = b.tau_0 / (2.0 * b.mu) * (ratio * ratio - 1.0 - 2.0 * std::log(ratio));
}

/// Delta method for the band around the fitted curve.
void report_band(const Bingham& b, const LeastSquaresFit& fit, const FitInput& input, FitResult& result) {
  const std::size_t n = fit.parameters.size();
  for (const double omega : result.curve.x) {
    const CouetteState s = reiner_riwlin(b, omega, input.instrument);
    std::vector<double> g;
    if (!input.tau_0) g.push_back(s.d_torque_d_tau_0);
    if (!input.mu) g.push_back(s.d_torque_d_mu);
    double variance = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) variance += g[i] * g[k] * fit.covariance[i * n + k];
    result.curve.standard_error.push_back(std::sqrt(std::max(0.0, variance)));
  }
}

void report_parameters(const Readings& r, const Fitted& f, const FitInput& input, FitResult& result) {
  const std::size_t n = f.fit.parameters.size();
  const double degrees = f.fit.degrees_of_freedom;
  const auto variance = [&](std::size_t k) { return f.fit.covariance[k * n + k]; };
  if (input.tau_0) {
    result.tau_0 = given(*input.tau_0);
  } else if (f.fit.told.front()) {
    const double stress = shear_stress_at(input.instrument.vane_radius, r.torque.front(), input.instrument);
    result.tau_0 = tell(f.bingham.tau_0, variance(0), degrees, std::max(f.bingham.tau_0, stress));
  }
  if (input.mu) {
    result.mu = given(*input.mu);
  } else if (f.fit.told.back() && f.bingham.mu > 0.0) {
    const double stress = shear_stress_at(input.instrument.vane_radius, r.torque.back(), input.instrument);
    const double apparent = stress / newtonian_shear_rate(r.x.back(), input.instrument);
    result.mu = tell(f.bingham.mu, variance(n - 1), degrees, std::max(f.bingham.mu, apparent));
  }
  if (f.bingham.tau_0 <= 0.0)
    result.notes.push_back(
        "yield_stress: the torque rises at least in proportion to the speed; its interval starts at 0");
  if (f.bingham.mu <= 0.0)
    result.notes.push_back(
        "plastic_viscosity: the torque does not rise with the speed, so the record cannot tell it");
  if (degrees <= 0.0)
    result.notes.push_back(
        "as many readings as parameters: the curve passes through all, and no interval can be told");
  if (!result.tau_0) result.notes.push_back("yield_stress: the record cannot tell it");
  if (!result.mu && f.bingham.mu > 0.0)
    result.notes.push_back("plastic_viscosity: the record cannot tell it");
}

}  // namespace

FitResult fit_flow_curve(const TorqueRecord& record, const FitInput& input) {
  FitResult result;
  result.kind = RecordKind::flow_curve;
  Readings r = readings_of(record, result);
  if (input.tau_0 && input.mu)
    throw std::invalid_argument(
        "both the yield stress and the plastic viscosity are given; nothing is left to fit");
  if (r.size() < 2)
    throw std::invalid_argument(
        "a flow curve needs at least two rows with a speed and a torque greater than 0; " +
        std::to_string(r.size()) + " found");
  if (!several_speeds(r))
    throw std::invalid_argument("all rows have the same speed; a flow curve needs two speeds or more");

  const std::size_t slow = below_torque_minimum(r, input);
  std::vector<char> leave_out(r.size(), 0);
  for (std::size_t i = 0; i < slow; ++i) {
    drop(result, r.line[i], r.x[i], r.torque[i],
         "below the torque minimum: the torque rises as the speed falls");
    leave_out[i] = 1;
  }
  r = without(r, leave_out);
  const Fitted f = least_squares(r, input);
  report(r, f.fit, result);
  report_parameters(r, f, input, result);
  report_plug(r, f.bingham, input, result);
  report_band(f.bingham, f.fit, input, result);
  return result;
}

}  // namespace tremie::fitting
