#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "libmpm/constitutive/laws/law_interface.hpp"

namespace tremie {

/// Exact Bingham, equation (27): rigid below tau_y, no regularisation in the result.
/// `epsilon` [1/s] is a smoothing for Newton's method alone; prox, which ADMM uses, is exact.
struct ExactBingham {
  double epsilon = 1e-6;

  static constexpr bool exact = true, viscous = false;
  static constexpr std::string_view word = "exact";
  static constexpr std::array<LawKey<ExactBingham>, 0> keys() { return {}; }

  double rounded(double gamma_dot) const { return std::sqrt(gamma_dot * gamma_dot + epsilon * epsilon); }
  double secant(double gamma_dot, double tau_y) const { return tau_y / rounded(gamma_dot); }
  double slope(double gamma_dot, double tau_y) const {
    const double g = rounded(gamma_dot);
    return -tau_y / (g * g * g);
  }
  double potential(double gamma_dot, double tau_y) const { return tau_y * (rounded(gamma_dot) - epsilon); }
  double prox(double a, double tau_y, double r) const { return std::max(0.0, a - tau_y) / r; }
  double stress(double, double tau_y) const { return tau_y; }
  double dual_limit(double, double tau_y) const { return tau_y; }
  double newtonian() const { return 0.0; }
  double viscosity(double, double) const { return 0.0; }
  double largest_secant(double tau_y) const { return tau_y > 0.0 ? unbounded : 0.0; }
};

}  // namespace tremie
