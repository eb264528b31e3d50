#pragma once

// What a yield law states. A law is a struct of its parameters in a file of this folder and a line in
// yield_law.hpp (YieldLaw); the solvers, the apparatus and the rheometer's torques name none. A fit of a flow curve names
// the laws that it can choose from: rheometer/fits/flow_law.hpp.
//
// Every law splits the deviatoric stress of a generalised Newtonian fluid into a Newtonian part, which the mix's
// plastic viscosity mu gives, and a part of its own,
//
//   tau = 2 [mu + s(gamma_dot)] D',     gamma_dot = sqrt(2 D':D'),
//   s = f(gamma_dot) / gamma_dot,       f = stress magnitude carried by the law's own part [Pa],
//
// with the shear rate gamma_dot [1/s] and the current yield stress tau_y = (1 + lambda) tau_0 [Pa] (equation (2) of
// Wilkes, Kumar and Biscontin; the laws are their equations (1), (27), (32), (33)). A law whose viscous part is not
// Newtonian carries all of it in f, and its mix has mu = 0. Each law states
//
//   secant(gamma_dot, tau_y)    s                                   [Pa s]
//   slope(gamma_dot, tau_y)     (ds/dgamma_dot) / gamma_dot         [Pa s^3]
//   potential(gamma_dot, tau_y) int_0^gamma_dot f                   [Pa/s], convex
//   prox(a, tau_y, r)           the d >= 0 with f(d) + r d = a, 0 where a is at most f(0); r > 0, or r = 0 where f grows
//                               without bound [1/s]
//   stress(gamma_dot, tau_y)    f, and at gamma_dot = 0 its limit from the side of flow [Pa]
//   dual_limit(gamma_dot, tau_y) the stress |s| that Newton's dual may carry, at most what keeps its tangent positive:
//                               secant^2 / (|slope| gamma_dot); tau_y will do where f has no viscous part, f elsewhere
//                               [Pa]
//   newtonian()                 the plastic viscosity that a law gives to the mix's mu because it is Bingham with other
//                               parameters (Herschel-Bulkley with n = 1: k); f then keeps no viscous part, and
//                               Reiner-Riwlin's formulas hold. 0 for every other law, and for Bingham itself [Pa s]
//   viscosity(gamma_dot, tau_y) (f - tau_y) / gamma_dot where f has a viscous part beyond mu, 0 else; for the stress
//                               scale of ADMM and the drag of side walls and bars [Pa s]
//   largest_secant(tau_y)       over the shear rates of a test, for the explicit step's limit; infinite where there is
//                               none [Pa s]
//
// none of which divides by a shear rate that may be zero, and
//
//   exact                       whether the stress at rest is anything up to tau_y
//   viscous                     whether it takes the place of the mix's plastic viscosity: then a key in [mix] says how much
//   word                        the word of model.yield that says how its yield is smoothed: "exact" or one of its own.
//                               Laws may share it, as Bingham and Herschel-Bulkley do; the keys in [mix] tell which is
//                               meant, so that no two have both the same
//   keys()                      the scene keys of its parameters; those in [mix] take the place of plastic_viscosity
//
// and may state simd_secant(gamma_dot, tau_y) for points side by side, where one by one is too slow for it.

#include <cstddef>
#include <limits>
#include <string_view>
#include <variant>

namespace tremie {

/// A parameter of the law L as a scene gives it: "model.…" beside model.yield, "mix.…" in place of
/// mix.plastic_viscosity, "mix.thixotropy.…" of kinetics (kinetics_interface.hpp).
template <class L>
struct LawKey {
  std::string_view name = {};      ///< dotted, "model.regularisation"
  double L::*member = nullptr;     ///< SI
  std::string_view unit = {};      ///< SI unit as the scene writes it; empty: a plain number
  std::string_view fallback = {};  ///< as the scene would write it; empty: must be given, if not optional
  std::string_view example = {};
  std::string_view help = {};
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  bool low_open = true;
  bool optional = false;  ///< left out, it is what the law's struct has
};

/// Calls visit(T{}) for every type T of a registry, which is a variant.
template <class Registry, std::size_t i = 0, class Visit>
void for_each_of(Visit visit) {
  if constexpr (i < std::variant_size_v<Registry>) {
    visit(std::variant_alternative_t<i, Registry>{});
    for_each_of<Registry, i + 1>(visit);
  }
}

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Hardly any point of a test shears faster for long [1/s].
inline constexpr double fastest_rate = 100.0;

/// What a flow of concrete under its own weight is about to stand at [1/s]: for the times that are expected of a run.
inline constexpr double typical_rate = 1.0;

/// Rates between which the viscosity of a law that is not Newtonian may be taken for the scale of its stresses [1/s].
inline constexpr double viscosity_scale_rates[2] = {0.01, fastest_rate};

/// Below it nothing is told from rest [1/s].
inline constexpr double slowest_rate = 1e-6;

}  // namespace tremie
