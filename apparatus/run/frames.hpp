#pragma once

// The points of a body at one time, for the files of a run.

#include <array>
#include <cmath>
#include <vector>

#include "apparatus/common/model.hpp"
#include "libmpm/boundary/flat_walls.hpp"
#include "libmpm/implicit/step.hpp"

namespace tremie::test_run {

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
std::vector<double> shear_rates_now(const Body<Geometry>& body) {
  constexpr int D = Geometry::dim;
  ActiveGrid<D> grid;
  grid.axes = body.grid.axes;
  grid.blocks = body.grid.blocks;
  activate(grid, body.points.x);
  NodalState<D> nodes;
  point_to_grid(grid, body.points, nodes);
  std::vector<char> fixed;
  std::vector<FrictionNode<D>> friction;
  detail::apply_flat_walls<D>(grid, body.walls, fixed, friction, nodes.v);
  detail::apply_blocks<D>(grid, fixed, nodes.v);
  std::vector<double> gamma_dot;
  shear_rate_at_points<Geometry>(grid, nodes.v, body.points, gamma_dot);
  return gamma_dot;
}

/// The body's points as they are now. The velocity of circling concrete is (0, v_theta, 0).
template <class Geometry>
Frame frame_of(const Body<Geometry>& body) {
  const auto& points = body.points;
  Frame frame;
  frame.time = body.time;
  frame.shear_rate = shear_rates_now(body);  // first: its grid is gone before the rest is there
  frame.position.reserve(points.size()), frame.velocity.reserve(points.size());
  frame.volume.reserve(points.size()), frame.pressure.reserve(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    frame.position.push_back(in_space<Geometry>(points.x[p]));
    frame.velocity.push_back(in_space<Geometry>(points.v[p]));
    if constexpr (Geometry::dim == 1) frame.velocity.back() = {0.0, points.v[p][0], 0.0};
    if constexpr (std::is_same_v<Geometry, Polar>) {
      const double c = std::cos(points.x[p][1]), s = std::sin(points.x[p][1]);
      const Vec<2>& v = points.v[p];
      frame.velocity.back() = {c * v[0] - s * v[1], s * v[0] + c * v[1], 0.0};
    }
    frame.volume.push_back(points.volume(p));
    frame.pressure.push_back(pressure(points.ln_J[p], body.mix.K));
  }
  frame.flocculation = points.lambda;
  return frame;
}

}  // namespace tremie::test_run
