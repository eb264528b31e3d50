#pragma once

// Yield laws of a generalised Newtonian fluid, equations (1), (27), (32) and (33) of Wilkes, Kumar and
// Biscontin.
//
// Every law splits the deviatoric stress into a Newtonian part and a part that carries the yield stress,
//
//   tau = 2 [mu + s(gamma_dot)] D',     gamma_dot = sqrt(2 D':D'),
//   s = f(gamma_dot) / gamma_dot,       f = stress magnitude carried by the yield part [Pa],
//
// and states four scalar functions of the shear rate gamma_dot [1/s] and the current yield stress tau_y [Pa]
// (tau_y = (1 + lambda) tau_0 for a thixotropic material, equation (2)):
//
//   secant(gamma_dot, tau_y)    s                                   [Pa s]
//   slope(gamma_dot, tau_y)     (ds/dgamma_dot) / gamma_dot         [Pa s^3]   (<= 0: shear thinning)
//   potential(gamma_dot, tau_y) int_0^gamma_dot f                   [Pa/s], convex
//   prox(a, tau_y, r)           the d >= 0 with f(d) + r d = a      [1/s]
//
// None of them divides by a shear rate that may be zero. A new law (Herschel-Bulkley, say) is one more struct
// here.

#include <algorithm>
#include <cmath>

namespace tremie {

/// Exact Bingham, equation (27): rigid below tau_y, no regularisation in the result.
/// `epsilon` [1/s] is a smoothing for Newton's method alone; prox, which ADMM uses, is exact.
struct ExactBingham {
  double epsilon = 1e-6;

  double rounded(double gamma_dot) const { return std::sqrt(gamma_dot * gamma_dot + epsilon * epsilon); }
  double secant(double gamma_dot, double tau_y) const { return tau_y / rounded(gamma_dot); }
  double slope(double gamma_dot, double tau_y) const {
    const double g = rounded(gamma_dot);
    return -tau_y / (g * g * g);
  }
  double potential(double gamma_dot, double tau_y) const { return tau_y * (rounded(gamma_dot) - epsilon); }
  double prox(double a, double tau_y, double r) const { return std::max(0.0, a - tau_y) / r; }
};

/// Papanastasiou's regularisation, equation (33); with tau_y = (1 + lambda) tau_0 the PR-Bingham law,
/// equation (34).
struct Papanastasiou {
  double m = 5.0;  ///< regularisation parameter [s]

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
  double prox(double a, double tau_y, double r) const;
};

/// Bi-viscous, equation (32), made continuous: f = tau_y gamma_dot / gamma_c below the critical shear rate
/// gamma_c, tau_y above, so that the viscosity before yield is mu_0 = mu + tau_y / gamma_c. (The paper's own
/// form jumps at gamma_c unless mu_0 has this value.)
struct BiViscous {
  double gamma_c = 0.01;  ///< critical shear rate [1/s]

  double secant(double gamma_dot, double tau_y) const { return tau_y / std::max(gamma_dot, gamma_c); }
  double slope(double gamma_dot, double tau_y) const {
    return gamma_dot > gamma_c ? -tau_y / (gamma_dot * gamma_dot * gamma_dot) : 0.0;
  }
  double potential(double gamma_dot, double tau_y) const {
    return gamma_dot < gamma_c ? 0.5 * tau_y * gamma_dot * gamma_dot / gamma_c
                               : tau_y * (gamma_dot - 0.5 * gamma_c);
  }
  double prox(double a, double tau_y, double r) const {
    const double below = a / (tau_y / gamma_c + r);
    return below <= gamma_c ? below : (a - tau_y) / r;
  }
};

/// f(d) = tau_y (1 - e^{-m d}) is concave in d, so f(d) + r d - a is too: Newton from d = 0 climbs to the
/// root without overshoot, and from the far side (a - tau_y)/r it falls below it in one step.
inline double Papanastasiou::prox(double a, double tau_y, double r) const {
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

}  // namespace tremie
