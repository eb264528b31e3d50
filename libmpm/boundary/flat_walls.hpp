#pragma once

// Flat walls at the ends of the grid's axes, and rigid blocks of whole cells: which nodal velocities they prescribe,
// and where a wall law acts. The spline at a wall is interpolatory, so a prescribed velocity is exact there.

#include <algorithm>
#include <array>
#include <vector>

#include "libmpm/boundary/wall_term.hpp"
#include "libmpm/grid/active_grid.hpp"

namespace tremie {

/// Velocities of the low and the high wall of each axis [m/s]; the normal component must be zero.
template <int D>
struct WallVelocities {
  std::array<std::array<Vec<D>, 2>, D> v;
  WallVelocities() {
    for (auto& axis : v) axis.fill(Vec<D>::Zero());
  }
};

namespace detail {

/// Walls at the ends of the axes: which components they prescribe, and the terms of a wall law (wall_law.hpp).
/// Nodes behind a plane of symmetry are no unknowns.
template <int D>
void apply_flat_walls(const ActiveGrid<D>& grid, const WallVelocities<D>& walls, std::vector<char>& fixed,
                      std::vector<NodeTerm<D>>& terms, std::vector<Vec<D>>& v) {
  fixed.assign(grid.node_index.size() * D, 0);
  for (const MirrorNode<D>& m : grid.mirrors) std::fill_n(&fixed[m.node * D], D, 1);
  for (int i = 0; i < grid.n_nodes(); ++i) {
    if (fixed[i * D]) continue;
    for (int a = 0; a < D; ++a) {
      const Axis& axis = grid.axes[a];
      const int j = grid.node_index[i][a];
      const FaceKind face = axis.on_low_wall(j)    ? axis.low
                            : axis.on_high_wall(j) ? axis.high
                                                   : FaceKind::open;
      if (face == FaceKind::open) continue;
      for (int d = 0; d < D; ++d)
        if (d == a || face == FaceKind::no_slip) {
          fixed[i * D + d] = 1;
          v[i][d] = walls.v[a][axis.on_low_wall(j) ? 0 : 1][d];
        }
      if (face == FaceKind::wall_law) {
        NodeTerm<D> term;
        term.node = i;
        term.normal_axis = a;
        term.reach = axis.h;
        term.velocity = walls.v[a][axis.on_low_wall(j) ? 0 : 1];
        terms.push_back(term);
      }
    }
  }
}

/// Blocks prescribe the velocities of their nodes.
template <int D>
void apply_blocks(const ActiveGrid<D>& grid, std::vector<char>& fixed, std::vector<Vec<D>>& v) {
  if (grid.blocks.empty()) return;
  for (int i = 0; i < grid.n_nodes(); ++i) {
    const Block<D>* block = block_of_node<D>(grid, grid.node_index[i]);
    if (!block) continue;
    v[i] = block->velocity(grid.node_position(i));
    for (int d = 0; d < D; ++d) fixed[i * D + d] = 1;
  }
}

}  // namespace detail
}  // namespace tremie
