#pragma once

// Keeps every cell of a full container in the body.
//
// In a section that is full of concrete no cell may be empty, but where the flow stretches the body its
// points draw apart, and a cell that they miss for a moment would be a hole: no stress in it, and the torque
// drops. The nearest point beside such a cell is halved, and one half put into its middle.

#include "libmpm/transfer/apic.hpp"

namespace tremie {
namespace detail {

/// The point beside an empty cell that is nearest to its middle, in cells; -1 where the cells around are
/// empty too.
template <int D>
int nearest_beside(const ActiveGrid<D>& grid, const Points<D>& points, const Index<D>& cell) {
  int nearest = -1;
  double least = 1e9;
  for (int k = 0; k < power(3, D); ++k) {
    Index<D> n = local_offset<D>(k), seen;
    for (int d = 0; d < D; ++d) {
      seen[d] = cell[d] + n[d] - 1;
      n[d] = grid.axes[d].cell(seen[d]);
    }
    const int c = grid.cell_map.at(n);
    if (c < 0) continue;
    for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
      const Vec<D> s = local_coordinates<D>(grid.axes, n, points.x[grid.order[i]]);
      double distance = 0.0;
      for (int d = 0; d < D; ++d) distance += std::pow(seen[d] + s[d] - cell[d] - 0.5, 2);
      if (distance < least) least = distance, nearest = grid.order[i];
    }
  }
  return nearest;
}

/// Halves point p; the new half goes to x.
template <int D>
void split_particle(Points<D>& points, int p, const Vec<D>& x) {
  points.mass[p] *= 0.5;
  points.V0[p] *= 0.5;
  add_point<D>(points, x, points.mass[p], points.V0[p], points.ln_J[p]);
  points.v.back() = points.v[p];
  points.C.back() = points.C[p];
  if (!points.thixotropic()) return;
  const double lambda = points.lambda[p], gamma_dot = points.gamma_dot[p];
  points.lambda.push_back(lambda);
  points.gamma_dot.push_back(gamma_dot);
  for (std::vector<double>& part : points.lambda_parts) part.push_back(part[p]);
}

}  // namespace detail

/// Puts a point into every cell of a grid that is bounded on all sides, blocks left out; returns how many
/// were empty. Mass and volume are kept.
template <int D>
int split_particles(const std::array<Axis, D>& axes, const std::vector<Block<D>>& blocks, Points<D>& points) {
  ActiveGrid<D> grid;
  grid.axes = axes;
  grid.blocks = blocks;
  activate(grid, points.x);
  IndexMap<D> all;
  Index<D> first{}, last;
  for (int d = 0; d < D; ++d) last[d] = axes[d].n_cells - 1;
  all.reset(first, last);
  int empty = 0;
  detail::for_each_index(all, [&](const Index<D>& cell, std::size_t) {
    if (grid.cell_map.at(cell) >= 0 || block_of_cell<D>(grid, cell)) return;
    const int p = detail::nearest_beside<D>(grid, points, cell);
    if (p < 0) return;
    detail::split_particle<D>(points, p, position_in_cell<D>(axes, cell, Vec<D>(Vec<D>::Constant(0.5))));
    ++empty;
  });
  return empty;
}

}  // namespace tremie
