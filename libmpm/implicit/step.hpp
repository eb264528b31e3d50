#pragma once

#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie {

/// Advances the body by one backward-Euler step of the material point method, on the geometries that step.cpp compiles:
/// Axisymmetric, PlaneStrain, Couette, Polar and ThreeD. `wall` is a moving rigid wall, or none.
template <class Geometry>
StepReport implicit_step(ImplicitBody<Geometry>& body, const YieldLaw& law, const StepSettings& settings,
                         const RigidWall<Geometry::dim>& wall = {});

}  // namespace tremie
