#include "rheometer/fits/decay_model.hpp"

#include <algorithm>
#include <cmath>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie::fitting {

namespace {

/// Slopes of a curve at its nodes, three-point formulae on uneven spacing.
std::vector<double> slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  std::vector<double> slope(n);
  const auto chord = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double left = x[i] - x[i - 1], right = x[i + 1] - x[i];
    slope[i] = (right * chord(i - 1) + left * chord(i)) / (left + right);
  }
  slope[0] = 2.0 * chord(0) - slope[1];
  slope[n - 1] = 2.0 * chord(n - 2) - slope[n - 2];
  return slope;
}

}  // namespace

double alpha_of(const DecayParameters& p) {
  return p[4] == 1.0 || !(p[2] > 0.0) ? p[3] : p[3] * std::pow(p[2], 1.0 - p[4]);
}

double flow_index_of(const FitInput& in) { return in.curve ? viscous_stress(*in.curve).n : 1.0; }

Thixotropy thixotropy_of(const DecayParameters& p, const FitInput& in) {
  // at rest before the test lambda grew from 0 to lambda_0, equation (8)
  const double A_thix = in.rest ? p[2] * p[0] / *in.rest : 0.0;
  return {A_thix, fitted(in.kinetics, alpha_of(p), p[4], in.gamma_c), p[2]};
}

DecayModel::DecayModel(const FitInput& input, const std::vector<double>& times, int intervals)
    : input_(input), intervals_(intervals) {
  constexpr int pieces = 120;
  const double end = times.back();
  for (int i = 0; i <= pieces; ++i) nodes_.push_back(end * i * i / (pieces * pieces));
  for (const double t : times) {
    const auto above = std::upper_bound(nodes_.begin(), nodes_.end() - 1, t);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, above - nodes_.begin() - 1));
    const double h = nodes_[i + 1] - nodes_[i], s = std::clamp((t - nodes_[i]) / h, 0.0, 1.0), u = 1.0 - s;
    places_.push_back({i, {u * u * (1.0 + 2.0 * s), s * s * (3.0 - 2.0 * s), h * s * u * u, -h * s * s * u}});
  }
}

void DecayModel::torque(const DecayParameters& p, std::span<double> result) const {
  CouetteFlow flow;
  flow.bingham = {p[0], p[1]};
  flow.omega = *input_.omega;
  flow.flow_index = flow_index_of(input_);
  flow.thixotropy = thixotropy_of(p, input_);
  CouetteOptions options;
  options.intervals = intervals_;
  options.relative_tolerance =
      1e-5;  // 6e-6 of the torque, as much as 3e-6 with the gate found, in a third of the time
  options.absolute_tolerance = 1e-6;
  options.whole_gap = false;
  options.find_gate = false;
  const CouetteDecay decay = thixotropic_couette(flow, nodes_, input_.instrument, options);
  const std::vector<double> slope = slopes(nodes_, decay.torque);
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto& [i, w] = places_[k];
    result[k] = w[0] * decay.torque[i] + w[1] * decay.torque[i + 1] + w[2] * slope[i] + w[3] * slope[i + 1];
  }
}

double yield_stress_from_torque(double torque, double mu, const FitInput& input) {
  const Instrument& in = input.instrument;
  const double n = flow_index_of(input);
  const auto with = [&](double tau_y) { return steady_torque({tau_y, mu, n}, *input.omega, in).torque; };
  if (with(0.0) >= torque) return 0.0;
  double low = 0.0, high = shear_stress_at(in.vane_radius, torque, in);  // nothing yields above this
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (with(middle) < torque ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace tremie::fitting
