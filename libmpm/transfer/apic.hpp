#pragma once

// Transfer between points and grid: affine particle-in-cell (APIC, Jiang et al. 2015), with FLIP as a blend.
//
// A point's affine velocity C is the least-squares slope of the nodal velocities around it under its own
// shape values; linear and angular momentum pass both ways unchanged, next to walls too, because the inertia
// tensor of the stencil is computed where the point is (tensor-product splines: it is diagonal).

#include <array>
#include <cmath>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/particles/advection.hpp"
#include "libmpm/particles/particles.hpp"
#include "libmpm/transfer/stencil_3d.hpp"

namespace tremie {

/// Nodal fields, one entry an active node.
template <int D>
struct NodalState {
  std::vector<double> mass;  ///< [kg]
  std::vector<Vec<D>> v;     ///< velocity after the transfer [m/s]
};

/// Wraps a place around periodic axes. The velocity normal to a wall vanishes on it, but a finite step may
/// still carry a point through: it stops just before.
template <int D>
void keep_in_domain(const std::array<Axis, D>& axes, Vec<D>& x) {
  for (int d = 0; d < D; ++d) {
    const Axis& a = axes[d];
    const double margin = 1e-6 * a.h;
    if (a.periodic) x[d] -= a.length() * std::floor((x[d] - a.origin) / a.length());
    if (a.wall_low()) x[d] = std::max(x[d], a.origin + margin);
    if (a.wall_high()) x[d] = std::min(x[d], a.origin + a.length() - margin);
  }
}

/// Stops a point that moved from `from` to x before the sheet that it would cross.
template <int D>
void keep_on_its_side(const ActiveGrid<D>& grid, const Sheet<D>& sheet, const Vec<D>& from, Vec<D>& x) {
  const Axis& axis = grid.axes[sheet.normal];
  const double wall = axis.origin + sheet.face * axis.h, before = from[sheet.normal] - wall,
               after = x[sheet.normal] - wall;
  if ((before < 0.0) == (after < 0.0)) return;
  const double at = from[sheet.along] + before / (before - after) * (x[sheet.along] - from[sheet.along]);
  if (at >= sheet.from && at < sheet.to) x[sheet.normal] = wall + std::copysign(1e-6 * axis.h, before);
}

/// Keeps a point that moved from `from` to x in the domain, on its side of sheets and out of blocks: one that would
/// enter a block stays.
template <int D>
void keep_in_domain(const ActiveGrid<D>& grid, const Vec<D>& from, Vec<D>& x) {
  keep_in_domain<D>(grid.axes, x);
  for (const Sheet<D>& sheet : grid.sheets) keep_on_its_side(grid, sheet, from, x);
  if (!grid.blocks.empty() && block_of_cell<D>(grid, detail::cell_of<D>(grid.axes, x))) x = from;
}

namespace detail {

/// Nodal vectors of the nodes of a cell, the control points of its splines.
template <int D>
std::array<Vec<D>, power(3, D)> at_controls(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& v, int c) {
  std::array<Vec<D>, power(3, D)> at_nodes;
  for (std::size_t k = 0; k < at_nodes.size(); ++k) at_nodes[k] = v[grid.cell_nodes[c][k]];
  return at_nodes;
}
inline CellQuads at_controls(const ActiveGrid<3>& grid, const std::vector<Vec<3>>& v, int c) {
  return of_cell(grid, v, c);
}

}  // namespace detail

/// Point to grid: nodal masses and velocities, momentum and angular momentum kept. The sums do not depend on
/// the threads.
template <int D>
void point_to_grid(const ActiveGrid<D>& grid, const Points<D>& points, NodalState<D>& nodes);

/// How grid velocities come back to the points.
struct Transfer {
  bool flip = false;
  double flip_blend = 0.95;  ///< share of the velocity increment, the rest is PIC
};

/// Grid to point: velocities and affine velocities from the nodal velocities v at the end of the step (v_old
/// at its start, for FLIP alone); the points move with the same v over dt, as their space has it.
template <int D>
void grid_to_point(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& v, const std::vector<Vec<D>>& v_old,
                   const Transfer& transfer, double dt, Points<D>& points, const StraightAhead& motion = {});
void grid_to_point(const ActiveGrid<2>& grid, const std::vector<Vec<2>>& v, const std::vector<Vec<2>>& v_old,
                   const Transfer& transfer, double dt, Points<2>& points, const Motion<Polar>& motion);

/// Affine velocities alone from the nodal velocities v, of points that have given theirs up.
template <int D>
void affine_from_grid(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& v, Points<D>& points);

/// Shear rate [1/s] at every point from the nodal velocities.
template <class Geometry>
void shear_rate_at_points(const ActiveGrid<Geometry::dim>& grid, const std::vector<Vec<Geometry::dim>>& v,
                          const Points<Geometry::dim>& points, std::vector<double>& gamma_dot);

}  // namespace tremie
