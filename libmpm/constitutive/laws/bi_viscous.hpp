#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "libmpm/constitutive/laws/law_interface.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie {

/// Bi-viscous, equation (32), made continuous: f = tau_y gamma_dot / gamma_c below the critical shear rate
/// gamma_c, tau_y above, so that the viscosity before yield is mu_0 = mu + tau_y / gamma_c. (The paper's own
/// form jumps at gamma_c unless mu_0 has this value.)
struct BiViscous {
  double gamma_c = 0.01;  ///< critical shear rate [1/s]

  static constexpr bool exact = false, viscous = false;
  static constexpr std::string_view word = "bi_viscous";
  static constexpr std::array<LawKey<BiViscous>, 1> keys() {
    return {{{"model.critical_shear_rate", &BiViscous::gamma_c, "1/s", "0.01 1/s", "0.01 1/s",
              "gamma_c of the yield law"}}};
  }

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
  double stress(double gamma_dot, double tau_y) const { return secant(gamma_dot, tau_y) * gamma_dot; }
  double dual_limit(double, double tau_y) const { return tau_y; }
  double newtonian() const { return 0.0; }
  double viscosity(double, double) const { return 0.0; }
  double largest_secant(double tau_y) const { return tau_y / gamma_c; }
  /// The secant of points side by side.
  template <class Simd>
  Simd simd_secant(const Simd& gamma_dot, const Simd& tau_y) const {
    return tau_y / max(gamma_dot, static_cast<ScalarOf<Simd>>(gamma_c) - Simd{});
  }
};

}  // namespace tremie
