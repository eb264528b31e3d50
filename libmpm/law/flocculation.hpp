#pragma once

// The flocculation state lambda of one material point, equation (3) of Wilkes, Kumar and Biscontin after
// Roussel (2006):
//
//   d lambda / dt = A_thix / tau_0 - alpha lambda gamma_dot,     static yield stress (1 + lambda) tau_0,
//   equation (7).
//
// Shear rates in 1/s, times in s, stresses in Pa; lambda and alpha have no unit.

#include <algorithm>
#include <cmath>

namespace tremie {

enum class Kinetics {
  roussel,  ///< equation (3) at all times
  gated     ///< the paper's algorithm: build-up below the critical shear rate, breakdown above it
};

struct Thixotropy {
  double A_thix = 0.0;  ///< structuration rate at rest [Pa/s]
  double alpha = 0.01;  ///< destructuration parameter
  Kinetics kinetics = Kinetics::gated;
  double gamma_c = 0.1;             ///< critical shear rate of the gate [1/s]
  double initial_flocculation = 0;  ///< lambda before any rest
};

/// lambda after a rest of duration `rest`: equation (3) at gamma_dot = 0 in closed form.
inline double flocculation_after_rest(double lambda, const Thixotropy& t, double tau_0, double rest) {
  return lambda + t.A_thix * rest / tau_0;
}

/// (1 - e^-k) / k, equal to 1 at k = 0.
inline double mean_decay(double k) { return k < 1e-8 ? 1.0 - 0.5 * k : -std::expm1(-k) / k; }

namespace detail {

/// Equation (3) over dt with the mean rate of a shear rate that is linear in time: exact at constant rate,
/// second order otherwise, positive and bounded for every dt.
inline double build_and_break(double lambda, double build_rate, double alpha, double gamma_0, double gamma_1,
                              double dt) {
  const double k = 0.5 * alpha * dt * (gamma_0 + gamma_1);
  return lambda * std::exp(-k) + build_rate * dt * mean_decay(k);
}

/// The gated kinetics over a step whose shear rate is linear in time, split where it crosses gamma_c.
inline double gated_step(double lambda, double build_rate, const Thixotropy& t, double gamma_0,
                         double gamma_1, double dt) {
  const bool rest_0 = gamma_0 < t.gamma_c, rest_1 = gamma_1 < t.gamma_c;
  const auto piece = [&](double value, bool rest, double g0, double g1, double duration) {
    return rest ? value + build_rate * duration : value * std::exp(-0.5 * t.alpha * duration * (g0 + g1));
  };
  if (rest_0 == rest_1) return piece(lambda, rest_0, gamma_0, gamma_1, dt);
  const double theta = std::clamp((t.gamma_c - gamma_0) / (gamma_1 - gamma_0), 0.0, 1.0);
  lambda = piece(lambda, rest_0, gamma_0, t.gamma_c, theta * dt);
  return piece(lambda, rest_1, t.gamma_c, gamma_1, (1.0 - theta) * dt);
}

}  // namespace detail

/// lambda at the end of a step of length dt in which the shear rate went from gamma_0 to gamma_1.
inline double flocculation_step(double lambda, const Thixotropy& t, double tau_0, double gamma_0,
                                double gamma_1, double dt) {
  const double build_rate = t.A_thix / tau_0;
  return t.kinetics == Kinetics::roussel
             ? detail::build_and_break(lambda, build_rate, t.alpha, gamma_0, gamma_1, dt)
             : detail::gated_step(lambda, build_rate, t, gamma_0, gamma_1, dt);
}

/// Static yield stress, equation (7) [Pa].
inline double static_yield_stress(double lambda, double tau_0) { return (1.0 + lambda) * tau_0; }

}  // namespace tremie
