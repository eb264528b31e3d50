#pragma once

// Walls inside the grid, sampled by boundary points: vane blades, a container, a gate.
//
// Setting the velocities of grid nodes near such a wall moves it by up to a cell. Here each point of the wall
// ties the velocity field where it lies to the wall's own, by a penalty of `stiffness` times the mass around
// it over dt: all of it where the concrete sticks, its normal part alone where it slips.

#include <vector>

#include "libmpm/boundary/point_terms.hpp"
#include "libmpm/transfer/apic.hpp"

namespace tremie {

/// A point of a wall.
template <int D>
struct BoundaryPoint {
  Vec<D> x;                          ///< [m]
  Vec<D> velocity = Vec<D>::Zero();  ///< of the wall [m/s]
  Vec<D> normal = Vec<D>::Zero();    ///< of a wall that the concrete slips along; zero where it sticks
};

/// The boundary points that lie in active cells.
template <int D>
std::vector<PointTerm<D>> find_penalty_points(const ActiveGrid<D>& grid, const NodalState<D>& nodes,
                                              const std::vector<BoundaryPoint<D>>& wall, double dt,
                                              double stiffness) {
  std::vector<PointTerm<D>> bound;
  for (std::size_t k = 0; k < wall.size(); ++k) {
    const Index<D> cell = detail::cell_of<D>(grid.axes, wall[k].x);
    PointTerm<D> point;
    point.cell = grid.cell_map.at(cell);
    if (point.cell < 0) continue;
    point.source = static_cast<int>(k);
    point.N = stencil<D>(grid.axes, cell, local_coordinates<D>(grid.axes, cell, wall[k].x)).N;
    point.velocity = point.target = wall[k].velocity;
    double mass = 0.0;
    for (int i = 0; i < power(3, D); ++i) mass += point.N[i] * nodes.mass[grid.cell_nodes[point.cell][i]];
    const bool sticks = wall[k].normal.isZero();
    point.penalty =
        stiffness * mass / dt *
        (sticks ? Mat<D, D>(Mat<D, D>::Identity()) : Mat<D, D>(wall[k].normal * wall[k].normal.transpose()));
    bound.push_back(point);
  }
  return bound;
}

}  // namespace tremie
