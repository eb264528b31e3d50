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
#include <limits>

#include "libmpm/constitutive/power_kinetics.hpp"

namespace tremie {

enum class Kinetics {
  roussel,  ///< equation (3) at all times
  gated,    ///< the paper's algorithm: build-up below the critical shear rate, breakdown above it
  power     ///< breakdown with a power of lambda, build-up to a saturation: power_kinetics.hpp
};

struct Thixotropy {
  double A_thix = 0.0;  ///< structuration rate at rest [Pa/s]
  double alpha = 0.01;  ///< destructuration parameter
  Kinetics kinetics = Kinetics::gated;
  double gamma_c = 0.1;             ///< critical shear rate of the gate [1/s]; power: 0 is no gate
  double initial_flocculation = 0;  ///< lambda before any rest
  double exponent = 1.0;            ///< n, power alone
  double saturation = std::numeric_limits<double>::infinity();  ///< lambda_max, power alone
};

/// Whether build-up and breakdown exclude each other at gamma_c.
inline bool has_gate(const Thixotropy& t) {
  return t.kinetics == Kinetics::gated || (t.kinetics == Kinetics::power && t.gamma_c > 0.0);
}

inline detail::PowerRates power_rates(const Thixotropy& t, double tau_0) {
  return {t.A_thix / tau_0, 1.0 / t.saturation, t.alpha, t.exponent};
}

/// lambda after a rest of duration `rest`: equation (3) at gamma_dot = 0 in closed form.
inline double flocculation_after_rest(double lambda, const Thixotropy& t, double tau_0, double rest) {
  if (t.kinetics == Kinetics::power) return detail::power_build(lambda, power_rates(t, tau_0), rest);
  return lambda + t.A_thix * rest / tau_0;
}

namespace detail {

/// What equation (3) needs of a step in which the rate breaks lambda down by e^-k. With u the share of the
/// step that is left and < > the mean weighted by e^-ku:
struct Decay {
  double end;        ///< e^-k
  double mean;       ///< int_0^1 e^-ku du = (1 - e^-k)/k
  double asymmetry;  ///< <u(1 - u)> = (k coth(k/2) - 2)/k^2
  double curvature;  ///< <u(1 - u)(1 - 2u)> = (1 - 6 asymmetry)/k
};

/// All four to rounding, k >= 0. Below 1/2 by e^-k = (P - kQ)/(P + kQ), the Pade approximant of order 12
/// (error 2e-17), in which the differences that cancel are taken by hand.
inline Decay decay(double k) {
  if (k < 0.5) {
    const double x = k * k;
    const double P = 1.0 + x * (5.0 / 44.0 + x * (1.0 / 792.0 + x * (1.0 / 665280.0)));
    const double Q = 0.5 + x * (1.0 / 66.0 + x * (1.0 / 15840.0));
    const double share = 1.0 / (P + k * Q);
    return {(P - k * Q) * share, 2.0 * Q * share, (1.0 / 12.0 + x * (1.0 / 880.0 + x * (1.0 / 665280.0))) / Q,
            k * (1.0 / 120.0 + x * (1.0 / 18480.0)) / Q};
  }
  const double end = std::exp(-k), asymmetry = (k * (1.0 + end) / (1.0 - end) - 2.0) / (k * k);
  return {end, (1.0 - end) / k, asymmetry, (1.0 - 6.0 * asymmetry) / k};
}

/// e^-z; where z is small, as it is in a step that resolves the history, by a Pade approximant (error 1e-13).
inline double exp_of_small(double z) {
  if (std::abs(z) > 0.01) return std::exp(-z);
  const double even = 1.0 + z * z / 12.0;
  return (even - 0.5 * z) / (even + 0.5 * z);
}

/// lambda after a step of equation (3): what is left of it, and what was built up meanwhile and is left,
/// A dt int_0^1 exp(-ku - z(u)) du with the mean <z> in place of z(u): an error of second order in z alone.
/// The integral is at most 1 because no rate is negative.
inline double build_and_break(double lambda, double build_rate, const Decay& d, double z, double dt) {
  return lambda * d.end + build_rate * dt * std::min(1.0, d.mean * exp_of_small(z));
}

/// Equation (3) over dt with a shear rate that is linear in time: exact at constant rate, fourth order at a
/// linear rate, second order where the rate is curved; positive and bounded for every dt.
inline double roussel_step(double lambda, double build_rate, double alpha, double gamma_0, double gamma_1,
                           double dt) {
  const double half = 0.5 * alpha * dt;
  const Decay d = decay(half * (gamma_0 + gamma_1));
  return build_and_break(lambda, build_rate, d, half * (gamma_1 - gamma_0) * d.asymmetry, dt);
}

/// The gated kinetics over a step whose shear rate is linear in time, split where it crosses gamma_c.
inline double gated_step(double lambda, double build_rate, const Thixotropy& t, double gamma_0,
                         double gamma_1, double dt) {
  const bool rest_0 = gamma_0 < t.gamma_c, rest_1 = gamma_1 < t.gamma_c;
  const auto piece = [&](double value, bool rest, double g0, double g1, double duration) {
    return rest ? value + build_rate * duration : value * decay(0.5 * t.alpha * duration * (g0 + g1)).end;
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
  switch (t.kinetics) {
    case Kinetics::roussel:
      return detail::roussel_step(lambda, build_rate, t.alpha, gamma_0, gamma_1, dt);
    case Kinetics::gated:
      return detail::gated_step(lambda, build_rate, t, gamma_0, gamma_1, dt);
    case Kinetics::power:
      break;
  }
  const detail::PowerRates rates = power_rates(t, tau_0);
  return has_gate(t) ? detail::gated_power_step(lambda, rates, t.gamma_c, gamma_0, gamma_1, dt)
                     : detail::power_step(lambda, rates, gamma_0, gamma_1, dt);
}

/// Static yield stress, equation (7) [Pa].
inline double static_yield_stress(double lambda, double tau_0) { return (1.0 + lambda) * tau_0; }

}  // namespace tremie
