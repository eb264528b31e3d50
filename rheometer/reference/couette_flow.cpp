#include "rheometer/reference/couette_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

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

}  // namespace

double couette_torque(const YieldLaw& law, double tau_y, double mu, double omega,
                      const Instrument& instrument) {
  check(instrument);
  if (!(omega > 0.0)) throw std::invalid_argument("the cylinder must turn");
  double low = 0.0, high = 1e-6;
  while (speed_under(high, law, tau_y, mu, instrument) < omega) low = high, high *= 2.0;
  while (high - low > 1e-11 * high) {
    const double middle = 0.5 * (low + high);
    (speed_under(middle, law, tau_y, mu, instrument) < omega ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace tremie
