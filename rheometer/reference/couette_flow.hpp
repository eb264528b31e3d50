#pragma once

#include <limits>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie {

/// A wall along which the concrete slides at the speed u where it takes tau_i + k_i u: the cylinder's or the container's.
/// The default holds.
struct SlidingWall {
  double radius = 1.0;                                     ///< [m]
  double tau_i = std::numeric_limits<double>::infinity();  ///< [Pa]
  double k_i = 0.0;                                        ///< [Pa s/m]
};

/// Torque [N m] that turns the inner cylinder at omega [rad/s] in a fluid of any yield law, steady and without inertia:
/// the T with
///
///   omega = int_{R_i}^{R_o} gamma_dot(tau)/r dr,   tau(r) = T/(2 pi h r^2),   mu gamma_dot + f(gamma_dot) = tau,
///
/// to 1e-10 of it, for the yield stress tau_y [Pa] and the plastic viscosity mu [Pa s]. What is below its yield stress
/// does not turn. A wall of radius R that slides adds to omega what it turns against the concrete, u/R with
/// T = 2 pi h R^2 (tau_i + k_i u). Throws std::invalid_argument unless omega > 0.
double couette_torque(const YieldLaw& law, double tau_y, double mu, double omega,
                      const Instrument& instrument, const SlidingWall& wall = {});

/// tau = tau_0 + k gamma_dot^n beyond tau_0.
struct HerschelBulkleyFluid {
  double tau_0 = 0.0;  ///< [Pa]
  double k = 1.0;      ///< [Pa s^n], > 0
  double n = 1.0;      ///< 0.2 to 2
};

/// Torque and its derivatives, to 1e-8 of it.
struct HerschelBulkleyTorque {
  double torque = 0.0;          ///< [N m]
  double sheared_radius = 0.0;  ///< [m]; R_o where all is sheared
  double d_tau_0 = 0.0, d_k = 0.0, d_n = 0.0;
};

/// The same torque for a fit, which needs the derivatives many thousand times:
///
///   omega = 1/2 int ((tau - tau_0)/k)^(1/n) dtau/tau from max(tau_0, T/(2 pi h R_o^2)) to T/(2 pi h R_i^2).
///
/// Throws std::invalid_argument unless omega > 0 and k > 0.
HerschelBulkleyTorque herschel_bulkley_torque(const HerschelBulkleyFluid& fluid, double omega,
                                              const Instrument& instrument);

/// Torque [N m] and sheared radius [m]; of n = 1 by Reiner and Riwlin's closed form. Throws as they do.
struct SteadyTorque {
  double torque = 0.0, sheared_radius = 0.0;
};
SteadyTorque steady_torque(const HerschelBulkleyFluid& fluid, double omega, const Instrument& instrument);

}  // namespace tremie
