#pragma once

// What happens on the controls of an explicit step: sums of the tiles, gravity, flat walls.

#include "libmpm/step/explicit_body.hpp"

namespace tremie::detail {

/// Flat walls on one control, v its velocity before them. A wall takes the velocity towards it; friction
/// takes up to the coefficient times that from the sliding.
template <int D>
void apply_walls(const std::array<Axis, D>& axes, const Shape<D>& shape, const WallVelocities<D>& walls,
                 double friction_coefficient, const Index<D>& control, NodeLanes& v) {
  for (int d = 0; d < D; ++d) {
    const Axis& axis = axes[d];
    const bool low = axis.wall_low() && control[d] == shape.low_wall();
    const bool high = axis.wall_high() && control[d] == axis.n_cells + 1;
    if (!low && !high) continue;
    const FaceKind kind = low ? axis.low : axis.high;
    const Vec<D>& wall = walls.v[d][low ? 0 : 1];
    if (kind == FaceKind::no_slip) {
      for (int e = 0; e < D; ++e) v[e] = wall[e];
    } else {
      const double pressing = low ? std::max(0.0, -v[d]) : std::max(0.0, v[d]);
      v[d] = 0.0;
      if (kind != FaceKind::friction) continue;
      double slip = 0.0;
      for (int e = 0; e < D; ++e)
        if (e != d) slip += (v[e] - wall[e]) * (v[e] - wall[e]);
      slip = std::sqrt(slip);
      const double kept = slip > 0.0 ? std::max(0.0, 1.0 - friction_coefficient * pressing / slip) : 0.0;
      for (int e = 0; e < D; ++e)
        if (e != d) v[e] = wall[e] + kept * (v[e] - wall[e]);
    }
  }
}

template <int D>
Index<D> control_of(const NodeBlock<D>& block, int k) {
  Index<D> control;
  for (int d = D - 1; d >= 0; --d, k /= tile_cells)
    control[d] = block.at[d] * tile_cells - 1 + k % tile_cells;
  return control;
}

/// Whether any control of a block may lie on a wall.
template <int D>
bool touches_wall(const std::array<Axis, D>& axes, const NodeBlock<D>& block) {
  for (int d = 0; d < D; ++d) {
    const int first = block.at[d] * tile_cells - 1;
    if (axes[d].wall_low() && first <= 1) return true;
    if (axes[d].wall_high() && first + tile_cells > axes[d].n_cells) return true;
  }
  return false;
}

/// Visits every control that points reach; `update(b, k, total)` makes the velocity of control k of block b
/// from the sum of the tiles.
template <class Space, class Update>
void for_each_node(const Body<Space>& body, ExplicitState<Space>& state, double friction_coefficient,
                   const std::vector<typename TileGrid<Space::dim>::Buffer>& buffers, Update update) {
  constexpr int D = Space::dim;
  TileGrid<D>& grid = state.grid;
  for_each_share(grid, first_block_of<D>, [&](int b) {
    const bool walls = touches_wall<D>(grid.axes, grid.blocks[b]);
    sum_tiles<D>(grid, b, buffers, [&](int row, const std::array<NodeLanes, tile_cells>& total) {
      for (int i = 0; i < tile_cells; ++i) {
        const int k = row * tile_cells + i;
        NodeLanes& v = grid.v[b][k];
        update(b, k, total[i]);
        if (walls && v[D] > 0.0)
          apply_walls<D>(grid.axes, state.shape, body.walls, friction_coefficient,
                         control_of<D>(grid.blocks[b], k), v);
      }
    });
  });
}

template <int D>
NodeLanes as_lanes(const Vec<D>& a) {
  NodeLanes r = {};
  for (int d = 0; d < D; ++d) r[d] = a[d];
  return r;
}

/// Velocities from the momenta (with the impulses of the stresses already in them), and gravity.
template <class Space>
void velocities_from_sums(const Body<Space>& body, ExplicitState<Space>& state, double friction,
                          const Vec<Space::dim>& gravity_impulse) {
  constexpr int D = Space::dim;
  const NodeLanes pull = as_lanes<D>(gravity_impulse);
  for_each_node(body, state, friction, state.grid.sums, [&](int b, int k, const NodeLanes& total) {
    const double mass = total[D];
    NodeLanes v = mass > 0.0 ? total / mass + pull : NodeLanes{};
    v[D] = mass;
    state.grid.v[b][k] = v;
  });
}

/// Adds impulses of the stresses and gravity to velocities that are there already.
template <class Space>
void add_impulses(const Body<Space>& body, ExplicitState<Space>& state, double friction,
                  const std::vector<typename TileGrid<Space::dim>::Buffer>& impulses, bool flip,
                  const Vec<Space::dim>& gravity_impulse) {
  constexpr int D = Space::dim;
  const NodeLanes pull = as_lanes<D>(gravity_impulse);
  for_each_node(body, state, friction, impulses, [&](int b, int k, const NodeLanes& total) {
    NodeLanes& v = state.grid.v[b][k];
    const double mass = v[D];
    if (flip) state.grid.v_start[b][k] = v;
    if (mass > 0.0) v += total / mass + pull;
    v[D] = mass;
  });
}

}  // namespace tremie::detail
