#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "libmpm/constitutive/laws/law_interface.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie {

/// Papanastasiou's regularisation, equation (33); with tau_y = (1 + lambda) tau_0 the PR-Bingham law,
/// equation (34).
struct Papanastasiou {
  double m = 5.0;  ///< regularisation parameter [s]

  static constexpr bool exact = false, viscous = false;
  static constexpr std::string_view word = "papanastasiou";
  static constexpr std::array<LawKey<Papanastasiou>, 1> keys() {
    return {{{"model.regularisation", &Papanastasiou::m, "s", "5 s", "5 s", "m"}}};
  }

  double secant(double gamma_dot, double tau_y) const {
    const double x = m * gamma_dot;
    if (x < 1e-5) return tau_y * m * (1.0 - 0.5 * x + x * x / 6.0);
    return tau_y * -std::expm1(-x) / gamma_dot;
  }
  double slope(double gamma_dot, double tau_y) const {
    const double x = m * gamma_dot;
    // (f' gamma_dot - f) / gamma_dot^3 = tau_y m^3 [x e^-x - (1 - e^-x)] / x^3, whose limit is singular like
    // -1/(2x).
    if (x < 1e-3) return -tau_y * m * m * m * (0.5 - x / 3.0 + x * x / 8.0) / std::max(x, 1e-12);
    return tau_y * m * m * m * (x * std::exp(-x) + std::expm1(-x)) / (x * x * x);
  }
  double potential(double gamma_dot, double tau_y) const {
    const double x = m * gamma_dot;
    if (x < 1e-3) return tau_y / m * x * x * (0.5 - x / 6.0 + x * x / 24.0);
    return tau_y / m * (x + std::expm1(-x));
  }
  /// f(d) = tau_y (1 - e^{-m d}) is concave in d, so f(d) + r d - a is too: Newton from d = 0 climbs to the
  /// root without overshoot, and from the far side (a - tau_y)/r it falls below it in one step.
  double prox(double a, double tau_y, double r) const {
    if (a <= 0.0) return 0.0;
    double d = std::max(a / (tau_y * m + r), (a - tau_y) / r);  // both lie below the root
    for (int i = 0; i < 60; ++i) {
      const double missing = std::expm1(-m * d);  // 1 - e^{-m d} would lose its digits at small m d
      const double residual = a + tau_y * missing - r * d;
      const double step = residual / (tau_y * m * (1.0 + missing) + r);
      d += step;
      if (std::abs(step) <= 1e-14 * d) break;
    }
    return d;
  }
  double stress(double gamma_dot, double tau_y) const { return secant(gamma_dot, tau_y) * gamma_dot; }
  double dual_limit(double, double tau_y) const { return tau_y; }
  double newtonian() const { return 0.0; }
  double viscosity(double, double) const { return 0.0; }
  double largest_secant(double tau_y) const { return m * tau_y; }
  /// The secant of points side by side.
  template <class Simd>
  Simd simd_secant(const Simd& gamma_dot, const Simd& tau_y) const {
    const auto a = static_cast<ScalarOf<Simd>>(m);
    return a * tau_y * mean_decay(a * gamma_dot);
  }
};

}  // namespace tremie
