#pragma once

// Explicit steps of the material point method. They are compiled in step.cpp, for Axisymmetric, PlaneStrain and ThreeD.

#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/explicit/state.hpp"

namespace tremie {

/// Sorts the body's points into tiles and brings their mass, momentum and first stresses to the grid.
/// body.points is empty from here to the next write_back.
template <class Geometry>
ExplicitState<Geometry> start_explicit(Body<Geometry>& body, const YieldLaw& law,
                                       const ExplicitSettings& settings, const Shape<Geometry::dim>& shape);

/// Advances the body by one step. Where it fails the points are not to be used. They are left on the tiles:
/// write_back brings them to body.points.
template <class Geometry>
ExplicitReport explicit_step(Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
                             ExplicitState<Geometry>& state, const RigidWall<Geometry::dim>& wall = {});

}  // namespace tremie
