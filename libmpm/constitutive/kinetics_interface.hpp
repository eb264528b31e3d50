#pragma once

// What kinetics of the flocculation state lambda state. Kinetics are a struct of their parameters in a file of this
// folder and a line in kinetics.hpp (Kinetics); the solvers, the apparatus, the commands and the fits name none. The
// references that verify an update have an equation of their own for each: rheometer/reference/kinetics_equations.hpp.
//
// With the build-up rate b = A_thix/tau_0 [1/s] and the shear rate gamma_dot [1/s], lambda has no unit. All kinetics state
//
//   update(lambda, b, gamma_0, gamma_1, dt)
//                    lambda after a step of dt in which the shear rate went from gamma_0 to gamma_1: of second order in
//                    dt at least, positive and bounded for every dt
//   after_rest(lambda, A_thix, tau_0, duration)
//                    lambda after a rest, in closed form
//   gate()           the critical shear rate, below which lambda only builds up and above which it only breaks down
//                    [1/s]; empty: it does both at all times
//   breaks_down()    whether shear breaks lambda down at all
//   fitted(alpha, n, gamma_c)
//                    the kinetics that a fit of a torque's decay finds with these; what they do not have is ignored
//
// none of which divides by a shear rate that may be zero, and
//
//   word             the word of mix.thixotropy.kinetics and of --kinetics
//   keys()           the scene keys of their parameters in [mix.thixotropy]. A key that several have is described by
//                    the first, and its help is that of all, each said once
//   decay_fit        how a fit of a torque's decay treats them
//
// and may state modes and of_mode(i), where lambda is a sum of parts that a point stores (Points::lambda_parts): their
// shares, and the kinetics of a part over its share; simd_update (as update, for points side by side, where one by one is
// too slow); and
// update_along(lambda, b, rate, start, gamma_0, gamma_1, dt) (as update, where the rate inside the step is known too).

#include <string_view>

#include "libmpm/constitutive/laws/law_interface.hpp"

namespace tremie {

/// How a fit of a torque's decay treats kinetics.
struct DecayFitRules {
  bool free_exponent = false;      ///< n is fitted besides alpha
  bool needs_speeds = false;       ///< one speed does not tell them: read_protocol fits them to several
  bool needs_rest = false;         ///< where no build-up is known they are the same as kinetics before them
  std::string_view contains = {};  ///< the word of the kinetics that they are at n = 1
};

template <class K>
constexpr LawKey<K> destructuration_key() {
  return {"mix.thixotropy.destructuration",
          &K::alpha,
          "",
          "0.01",
          "",
          "alpha; the paper uses 0.01, spreads measured after a rest imply 1 or more",
          0.0,
          unbounded,
          false};
}

}  // namespace tremie
