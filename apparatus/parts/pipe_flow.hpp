#pragma once

// Flow of a yield stress fluid through a pipe, far from its ends: the Rabinowitsch-Mooney integral over any yield law,
//
//   Q = pi R^3 / tau_w^3 int_0^tau_w tau^2 gamma_dot dtau = pi R^3 / 3 (gamma_w - 1/tau_w^3 int_0^gamma_w tau^3 dgamma_dot),
//
// whose closed form for Bingham is that of Buckingham and Reiner. The pressure gradient is 2 tau_w / R.

#include <cmath>
#include <numbers>

#include "libmpm/constitutive/laws/yield_law.hpp"

namespace tremie {

/// Flow [m^3/s] through a pipe of radius R [m] at the wall's shear rate [1/s]; `mu` [Pa s] and `law` as a mix has them, the
/// yield stress tau_y [Pa].
inline double pipe_flow_at(double wall_rate, double R, const YieldLaw& law, double mu, double tau_y) {
  const auto tau = [&](double rate) { return mu * rate + stress(law, rate, tau_y); };
  // Simpson's rule in sqrt(rate), where the powers of a law at slow rates are smooth.
  constexpr int n = 64;
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) {
    const double x = static_cast<double>(i) / n;
    const double weight = i == 0 || i == n ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    sum += weight * 2.0 * x * std::pow(tau(wall_rate * x * x) / tau(wall_rate), 3);
  }
  return std::numbers::pi * R * R * R / 3.0 * wall_rate * (1.0 - sum / (3.0 * n));
}

/// Pressure gradient [Pa/m] that drives the flow [m^3/s] through the pipe; at no flow, the one at which it would begin.
inline double pipe_pressure_gradient(double flow, double R, const YieldLaw& law, double mu, double tau_y) {
  const auto gradient = [&](double rate) { return 2.0 / R * (mu * rate + stress(law, rate, tau_y)); };
  if (!(flow > 0.0)) return gradient(0.0);
  double low = -40.0, high = 40.0;  // logarithms of the wall's rate
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (pipe_flow_at(std::exp(middle), R, law, mu, tau_y) < flow ? low : high) = middle;
  }
  return gradient(std::exp(low));
}

}  // namespace tremie
