#include "rheometer/reference/couette_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie {
namespace {

/// Speed of the inner cylinder under the torque T [rad/s]: Gauss' rule in ln r on intervals that lie in the sheared part.
double speed_under(double T, const YieldLaw& law, double tau_y, double mu, const Instrument& in) {
  constexpr int n = 200;
  const double stress_1 = T / (2.0 * std::numbers::pi * in.vane_height);  // at r = 1 m
  const double yielding = is_exact(law) && tau_y > 0.0 ? std::sqrt(stress_1 / tau_y) : in.container_radius;
  const double from = std::log(in.vane_radius), to = std::log(std::min(in.container_radius, yielding));
  if (to <= from) return 0.0;
  const double half = 0.5 * (to - from) / n, offset = half * std::sqrt(0.6);
  const auto rate = [&](double ln_r) { return prox(law, stress_1 * std::exp(-2.0 * ln_r), tau_y, mu); };
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double middle = from + (2 * i + 1) * half;
    sum += half / 9.0 * (5.0 * rate(middle - offset) + 8.0 * rate(middle) + 5.0 * rate(middle + offset));
  }
  return sum;
}

/// What a wall slides under the torque T, over its radius [rad/s].
double sliding_under(double T, const SlidingWall& wall, const Instrument& in) {
  const double tau = T / (2.0 * std::numbers::pi * wall.radius * wall.radius * in.vane_height);
  if (!(tau > wall.tau_i)) return 0.0;
  return (tau - wall.tau_i) / (wall.k_i * wall.radius);  // without end where nothing is viscous
}

}  // namespace

double couette_torque(const YieldLaw& law, double tau_y, double mu, double omega,
                      const Instrument& instrument, const SlidingWall& wall) {
  check(instrument);
  if (!(omega > 0.0)) throw std::invalid_argument("the cylinder must turn");
  const auto speed = [&](double T) {
    return speed_under(T, law, tau_y, mu, instrument) + sliding_under(T, wall, instrument);
  };
  double low = 0.0, high = 1e-6;
  while (speed(high) < omega) low = high, high *= 2.0;
  while (high - low > 1e-11 * high) {
    const double middle = 0.5 * (low + high);
    (speed(middle) < omega ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

namespace {

/// Speed that a stress at the vane drives, and its derivatives.
struct Driven {
  double speed = 0.0, d_stress = 0.0, d_tau_0 = 0.0, d_k = 0.0, d_s = 0.0;
};

/// The integral over y = (tau - tau_0)/(stress - tau_0) = v^4, in which y^(1/n) is smooth from the edge of the plug on,
/// by Gauss' rule with eight points on four intervals.
Driven driven_by(double stress, const HerschelBulkleyFluid& f, double outer_share) {
  static constexpr double node[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                    0.9602898564975363};
  static constexpr double weight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                      0.1012285362903763};
  constexpr int intervals = 4;
  Driven d;
  const double excess = stress - f.tau_0, s = 1.0 / f.n;
  if (excess <= 0.0) return d;
  const double outer = outer_share * stress, y_low = std::max(0.0, (outer - f.tau_0) / excess);
  const double from = std::sqrt(std::sqrt(y_low)), half = 0.5 * (1.0 - from) / intervals;
  const auto add = [&](double v, double w) {
    const double y = v * v * v * v, x = excess * y / f.k;
    const double common = w * half * 4.0 * v * v * v * excess / (f.tau_0 + excess * y);
    const double rate = std::pow(x, s) * common;
    d.speed += rate;
    d.d_tau_0 -= s / f.k * rate / x;
    d.d_s += std::log(x) * rate;
  };
  for (int i = 0; i < intervals; ++i) {
    const double middle = from + (2 * i + 1) * half;
    for (int j = 0; j < 4; ++j) {
      add(middle + half * node[j], weight[j]);
      add(middle - half * node[j], weight[j]);
    }
  }
  d.speed *= 0.5;
  d.d_tau_0 *= 0.5;
  d.d_s *= 0.5;
  d.d_k = -s / f.k * d.speed;
  d.d_stress = 0.5 * (std::pow(excess / f.k, s) - std::pow(std::max(0.0, outer - f.tau_0) / f.k, s)) / stress;
  return d;
}

}  // namespace

HerschelBulkleyTorque herschel_bulkley_torque(const HerschelBulkleyFluid& f, double omega,
                                              const Instrument& in) {
  if (!(omega > 0.0) || !(f.k > 0.0))
    throw std::invalid_argument("the cylinder must turn, and k be greater than 0");
  const double ratio = in.vane_radius / in.container_radius, share = ratio * ratio;
  double low = f.tau_0, high = f.tau_0 + f.k * std::pow(2.0 * omega, f.n) + 1e-12;
  while (driven_by(high, f, share).speed < omega) low = high, high *= 2.0;
  double stress = 0.5 * (low + high);
  Driven d;
  for (int i = 0; i < 100; ++i) {  // Newton's method, halving where it would leave the bracket
    d = driven_by(stress, f, share);
    (d.speed < omega ? low : high) = stress;
    double next = d.d_stress > 0.0 ? stress - (d.speed - omega) / d.d_stress : low;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const bool done = std::abs(next - stress) <= 1e-12 * stress;
    stress = next;
    if (done) break;
  }
  d = driven_by(stress, f, share);
  const double to_torque = 2.0 * std::numbers::pi * in.vane_radius * in.vane_radius * in.vane_height;
  HerschelBulkleyTorque t;
  t.torque = stress * to_torque;
  const double by_stress = to_torque / d.d_stress;
  t.d_tau_0 = -d.d_tau_0 * by_stress;
  t.d_k = -d.d_k * by_stress;
  t.d_n = d.d_s / (f.n * f.n) * by_stress;
  t.sheared_radius = f.tau_0 > 0.0
                         ? std::min(in.container_radius, in.vane_radius * std::sqrt(stress / f.tau_0))
                         : in.container_radius;
  return t;
}

SteadyTorque steady_torque(const HerschelBulkleyFluid& f, double omega, const Instrument& in) {
  if (f.n == 1.0) {
    const CouetteState s = reiner_riwlin({f.tau_0, f.k}, omega, in);
    return {s.torque, s.sheared_radius};
  }
  const HerschelBulkleyTorque t = herschel_bulkley_torque(f, omega, in);
  return {t.torque, t.sheared_radius};
}

}  // namespace tremie
