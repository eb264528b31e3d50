#pragma once

// Equation (3) of Wilkes, Kumar and Biscontin after Roussel (2006), at all times:
//
//   d lambda / dt = A_thix / tau_0 - alpha lambda gamma_dot.

#include <array>
#include <cstddef>
#include <optional>

#include "libmpm/constitutive/cubic_rate.hpp"
#include "libmpm/constitutive/exponential_decay.hpp"
#include "libmpm/constitutive/kinetics_interface.hpp"

namespace tremie {

struct RousselKinetics {
  double alpha = 0.01;  ///< destructuration parameter

  static constexpr std::string_view word = "roussel";
  static constexpr DecayFitRules decay_fit{.needs_rest = true};  // without build-up it is the gated equation
  static constexpr std::array<LawKey<RousselKinetics>, 1> keys() {
    return {destructuration_key<RousselKinetics>()};
  }
  static RousselKinetics fitted(double alpha, double, double) { return {alpha}; }

  std::optional<double> gate() const { return std::nullopt; }
  bool breaks_down() const { return alpha != 0.0; }
  double after_rest(double lambda, double A_thix, double tau_0, double duration) const {
    return lambda + A_thix * duration / tau_0;
  }

  /// Exact at constant rate, fourth order at a linear rate, second order where the rate is curved.
  double update(double lambda, double build_rate, double gamma_0, double gamma_1, double dt) const {
    const double half = 0.5 * alpha * dt;
    const detail::Decay d = detail::decay(half * (gamma_0 + gamma_1));
    return detail::build_and_break(lambda, build_rate, d, half * (gamma_1 - gamma_0) * d.asymmetry, dt);
  }

  f64x8 simd_update(const f64x8& lambda, double build_rate, const f64x8& gamma_0, const f64x8& gamma_1,
                    double dt) const {
    const double built = build_rate * dt, half = 0.5 * alpha * dt;
    const f64x8 k = half * (gamma_0 + gamma_1), d = mean_decay(k);
    const f64x8 ones = all_lanes(1.0), left = d * exp(-(half * (gamma_1 - gamma_0) * decay_asymmetry(k, d)));
    return lambda * (1.0 - k * d) + built * min(left, ones);
  }

  /// Sixth order. alpha dt int_x^1 gamma_dot dx = ku + c u(1 - u) + d u(1 - u)(1 - 2u) + ..., u = 1 - x; the
  /// variance of u(1 - u), 1/180 at k = 0 and 1/k^2 far from it, is the second term of the mean of the exponential.
  template <class Rate>
  double update_along(double lambda, double build_rate, const Rate& rate, double start, double gamma_0,
                      double gamma_1, double dt) const {
    const detail::CubicRate cubic = detail::cubic_rate(rate, start, gamma_0, gamma_1, dt);
    const double k = alpha * dt * cubic.mean, c = alpha * dt * cubic.a1;
    const detail::Decay d = detail::decay(k);
    const double z = c * d.asymmetry + alpha * dt * cubic.a2 * d.curvature - 0.5 * c * c / (180.0 + k * k);
    return detail::build_and_break(lambda, build_rate, d, z, dt);
  }
};

}  // namespace tremie
