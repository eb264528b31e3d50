#pragma once

// The steady creeping flow of a Bingham fluid between a bladed vane and its container, by finite elements: an
// independent answer for the torque on blades, which has no closed form with a yield stress.
//
// Half of the sector of one blade, from the blade's middle to the middle between two blades. The flow turned
// back is the flow's mirror image, so on both of these lines, outside the blade, the fluid crosses at right
// angles and without normal traction: u_r = 0, sigma_theta_theta = 0. Velocities u_r and u_theta quadratic,
// pressure bilinear, on quadrilaterals in (r, theta) that close up towards the blade's tip. The yield stress
// is regularised, eta = mu + tau_0 / sqrt(gamma_dot^2 + eps^2) (Bercovier and Engelman 1980), eps halved
// again and again, each solved by Newton's method; the torque is linear in eps, so the last two give that of
// the exact yield stress. Inertia is left out. At n of 8, 16, 32 the torque of Mix A's ICAR vane agrees
// within 0.06 %.

#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::verification {

/// SI units; `n` elements between shaft and tip, as many between tip and container, as many between blades.
struct BladeFlow {
  double tau_0, mu, omega;
  double radius, container_radius, shaft_radius, thickness, height;
  int blades = 4;
  int n = 16;
  double regularisation = 1e-2;  ///< the last eps [1/s]; Newton's method fails somewhere below 5e-3
};

/// The flow around a scene's blades at its constant speed.
BladeFlow blade_flow_of(const icar_vane::Scene& scene, int n);

/// Torque [N m] on the vane, its whole height: the dissipated power over Omega. Throws std::runtime_error
/// where Newton's method does not converge.
double finite_element_torque(const BladeFlow& flow);

}  // namespace tremie::verification
