#pragma once

#include "libmpm/constitutive/yield_law.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie {

/// Torque [N m] that turns the inner cylinder at omega [rad/s] in a fluid of any yield law, steady and without inertia:
/// the T with
///
///   omega = int_{R_i}^{R_o} gamma_dot(tau)/r dr,   tau(r) = T/(2 pi h r^2),   mu gamma_dot + f(gamma_dot) = tau,
///
/// to 1e-10 of it, for the yield stress tau_y [Pa] and the plastic viscosity mu [Pa s]. What is below its yield stress
/// does not turn. Throws std::invalid_argument unless omega > 0.
double couette_torque(const YieldLaw& law, double tau_y, double mu, double omega,
                      const Instrument& instrument);

}  // namespace tremie
