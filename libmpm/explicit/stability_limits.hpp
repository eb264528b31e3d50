#pragma once

// How long an explicit step may be.
//
// A field of velocities on the nodes, v = phi(t) e with e an eigenvector of the lumped pencil (K_1, M),
// K_1 the stiffness of unit viscosity (or of unit bulk modulus) and M the mass of unit density, decays at the
// rate eta/rho kappa/h^2 under a viscosity eta and rings at the angular frequency sqrt(K/rho chi)/h under a
// bulk modulus K; kappa and chi are eigenvalues on cells of size 1. One step multiplies the decay by 1 - dt
// eta kappa/(rho h^2), so that it is stable for
//
//   dt < 2/kappa rho h^2/eta,        dt < 2/sqrt(chi) h/sqrt(K/rho),
//
// each alone. Together (stress from velocities, pressure from the volume, one after the other) the polynomial
// z^2 - (2 - c dt - omega^2 dt^2) z + 1 - c dt has its roots in the unit circle for omega^2 dt^2 + 2 c dt
// < 4.
//
// kappa and chi are the largest eigenvalues of a body that fills its cells, with its surface on a face of the
// grid or flat walls at its ends: the worst of the patches in tests/libmpm/test_explicit_limits.cpp, which
// computes them. Inside an endless body kappa is 2 for stretching (the spline's 3/2 times 4/3); free corners
// raise it to 4, and where the concrete slides along a wall the open end of the spline does, to 5.4. chi is
// largest at free corners, whose nodes have little mass: 4.2 for splines, 5.9 for GIMP. The way from the
// grid to the points and back leaves such a mode a share p of its velocity, and the second condition becomes
// omega^2 dt^2 < 2 (1 + p); chi is taken by a third larger, for p down to 1/2.
//
// A point that shares its nodes with no other rings faster than a body: chi is the sum of h^2 over the
// second moment of its weights in each direction, up to 24 (GIMP, in space). These limits are not its own:
// strays may run away at 0.4 to 0.7 h/sqrt(K/rho) (tests/verification/explicit.md).

#include <algorithm>
#include <cmath>
#include <limits>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/constitutive/mix.hpp"
#include "libmpm/transfer/shape_functions.hpp"

namespace tremie {

/// Largest eigenvalues on cells of size 1.
struct Eigenvalues {
  double viscous = 0.0;   ///< kappa
  double acoustic = 0.0;  ///< chi
};

/// Longest stable steps [s].
struct StabilityLimits {
  double viscous = std::numeric_limits<double>::infinity();
  double acoustic = std::numeric_limits<double>::infinity();
  double together = std::numeric_limits<double>::infinity();
};

/// The eigenvalues that the limits are computed with, for one divergence a cell or one a point.
inline Eigenvalues largest_eigenvalues(ShapeFunctions shape) {
  return shape == ShapeFunctions::gimp ? Eigenvalues{6.1, 7.8} : Eigenvalues{5.4, 5.6};
}

/// Limits for the stiffest state of the concrete, tau_y the largest static yield stress in it [Pa]; h: the
/// smallest cell size [m].
template <class Law>
StabilityLimits stability_limits(const Mix& mix, const Law& law, double tau_y, const Eigenvalues& eigen,
                                 double h) {
  const double decay = (mix.mu + largest_secant(law, tau_y)) / mix.density * eigen.viscous / (h * h);
  const double omega2 = mix.K / mix.density * eigen.acoustic / (h * h);
  return {2.0 / decay, 2.0 / std::sqrt(omega2), 4.0 / (decay + std::sqrt(decay * decay + 4.0 * omega2))};
}

}  // namespace tremie
