#pragma once

// Flat walls at the ends of the grid's axes, rigid blocks of whole cells and sheets between them: which nodal
// velocities they prescribe, and where a wall law acts. The spline at a wall is interpolatory, so a prescribed velocity is exact there.

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

/// Of a wall law at a node; what it holds with is set by the law.
template <int D>
NodeTerm<D> term_at(int node, int normal_axis, double reach, const Vec<D>& velocity) {
  NodeTerm<D> term;
  term.node = node, term.normal_axis = normal_axis, term.reach = reach, term.velocity = velocity;
  return term;
}

/// Walls at the ends of the axes: which components they prescribe, and the terms of a wall law (wall_law.hpp).
/// Nodes behind a plane of symmetry are no unknowns. On a line of circles (Couette) the one velocity is along the wall, and
/// a term counts it: its normal axis is -1.
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
        if ((D > 1 && d == a) || face == FaceKind::no_slip) {
          fixed[i * D + d] = 1;
          v[i][d] = walls.v[a][axis.on_low_wall(j) ? 0 : 1][d];
        }
      if (face == FaceKind::wall_law)
        terms.push_back(term_at(i, D > 1 ? a : -1, axis.h, walls.v[a][axis.on_low_wall(j) ? 0 : 1]));
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

/// Sheets hold back what would go through them, and all of what sticks to them; along one with a wall law there are terms
/// of it.
template <int D>
void apply_sheets(const ActiveGrid<D>& grid, std::vector<char>& fixed, std::vector<NodeTerm<D>>& terms,
                  std::vector<Vec<D>>& v) {
  if (grid.sheets.empty()) return;
  for (int i = 0; i < grid.n_nodes(); ++i) {
    const Sheet<D>* sheet = sheet_at_node<D>(grid, grid.node_index[i]);
    if (!sheet) continue;
    for (int d = 0; d < D; ++d)
      if (sheet->contact == FaceKind::no_slip || d == sheet->normal) {
        fixed[i * D + d] = 1;
        v[i][d] = sheet->velocity[d];
      }
    if (sheet->contact == FaceKind::wall_law)
      terms.push_back(term_at(i, sheet->normal, grid.axes[sheet->normal].h, sheet->velocity));
  }
}

}  // namespace detail
}  // namespace tremie
