#pragma once

#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie {

/// Advances the body by one backward-Euler step of the material point method, on the geometries that step.cpp compiles:
/// Axisymmetric, PlaneStrain, Couette, Polar and ThreeD. `wall` is a moving rigid wall, or none.
///
/// Before the first step the caller sets mix, gravity, the grid's axes and the points; with a thixotropic mix also their
/// lambda and gamma_dot (Points). The step keeps number and order of the points; their arrays may move in memory.
///
/// Its length is `fixed_dt` or chosen. A chosen step that does not converge is tried again over half the time, up to three
/// times, and the last try is kept: `converged` is false. Where its velocities are not finite or run away, `failed` is true:
/// points and time are as before the step.
template <class Geometry>
StepReport implicit_step(ImplicitBody<Geometry>& body, const YieldLaw& law, const StepSettings& settings,
                         const RigidWall<Geometry::dim>& wall = {});

}  // namespace tremie
