#pragma once

// A material cell that is elastic below its yield stress, in simple shear (Saramito, J. Non-Newtonian Fluid Mech. 145 (2007)
// 1, at small strains): an elastic strain and the yield law in series,
//
//   d tau/dt = G (gamma_dot - gamma_p),   tau = mu gamma_p + f(gamma_p, (1 + lambda) tau_0) where gamma_p > 0,
//
// and structure breaks down by the plastic shear rate gamma_p: below yield it only builds up.

#include <vector>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie {

struct ElasticCell {
  double stress = 0.0;        ///< [Pa]
  double plastic_rate = 0.0;  ///< gamma_p [1/s]
  double lambda = 0.0;
  std::vector<double> parts = {};  ///< of lambda, where it has any
  double strain = 0.0;             ///< since shear began [-]
  double largest_stress = 0.0, strain_at_largest_stress = 0.0;
  double substep = 0.0;  ///< of the last step, which the next begins with [s]; 0: none yet
};

/// Advances the cell by dt, in which the shear rate goes linearly from gamma_0 to gamma_1 [1/s]. Return maps (the law's
/// prox) in a singly diagonally implicit Runge-Kutta scheme of second order, in substeps: each within 1e-6 of the stress of
/// backward Euler. mix.G > 0 and an exact law.
void advance(ElasticCell& cell, const Mix& mix, const YieldLaw& law, double gamma_0, double gamma_1,
             double dt);

}  // namespace tremie
