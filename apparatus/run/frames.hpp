#pragma once

// The points of a body at one time, for the files of a run.

#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "apparatus/common/model.hpp"
#include "libmpm/body/body.hpp"

namespace tremie::experiment {

/// Place of a point for the frames: an axisymmetric section lies in the plane (r, 0, z), a plane one in (x,
/// y, 0), circling concrete on the line (r, 0, 0).
template <class Geometry>
std::array<double, 3> in_space(const Vec<Geometry::dim>& x) {
  if constexpr (Geometry::dim == 3)
    return {x[0], x[1], x[2]};
  else if constexpr (Geometry::dim == 1)
    return {x[0], 0.0, 0.0};
  else if constexpr (std::is_same_v<Geometry, Axisymmetric>)
    return {x[0], 0.0, x[1]};
  else if constexpr (std::is_same_v<Geometry, Polar>)
    return {x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), 0.0};
  else
    return {x[0], x[1], 0.0};
}

/// Shear rates where the points are now [1/s], from their own velocities: the body's grid is that of the last
/// step's start.
template <class Geometry>
std::vector<double> shear_rates_now(const Body<Geometry>& body);

/// The body's points as they are now. The velocity of circling concrete is (0, v_theta, 0).
template <class Geometry>
Frame frame_of(const Body<Geometry>& body);

}  // namespace tremie::experiment
