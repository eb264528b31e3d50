#pragma once

// A wall anywhere in the grid along which the step's wall law holds with a stress (wall_law_interface.hpp), sampled by strips.
// What keeps the concrete from going through it is a boundary point with the same normal (boundary_points.hpp); a strip takes
// from what slides past it the wall law's stress on its wetted area.

#include "libmpm/geometry/geometries.hpp"

namespace tremie {

/// A piece of a wall.
template <int D>
struct WallStrip {
  Vec<D> x;                          ///< [m]
  Vec<D> normal = Vec<D>::Zero();    ///< unit vector, into the concrete
  Vec<D> velocity = Vec<D>::Zero();  ///< of the wall [m/s]
  double area = 0.0;                 ///< [m^2]; of a plane section, of a metre
};

}  // namespace tremie
