#pragma once

// What happens on the nodes of an explicit step: sums of the tiles, gravity, flat walls.

#include "libmpm/explicit/state.hpp"

namespace tremie::detail {

/// Flat walls on one node, v its velocity before them. A wall takes the normal velocity; a wall law takes from the
/// sliding up to the yield force that it makes of what went into the wall. No law: walls take nothing from it.
template <int D>
void apply_walls(const std::array<Axis, D>& axes, const Shape<D>& shape, const WallVelocities<D>& walls,
                 const WallLaw* law, const Index<D>& node, f64x4& v) {
  for (int d = 0; d < D; ++d) {
    const Axis& axis = axes[d];
    const bool low = axis.wall_low() && node[d] == shape.low_wall();
    const bool high = axis.wall_high() && node[d] == axis.n_cells + 1;
    if (!low && !high) continue;
    const FaceKind kind = low ? axis.low : axis.high;
    const Vec<D>& wall = walls.v[d][low ? 0 : 1];
    if (kind == FaceKind::no_slip) {
      for (int e = 0; e < D; ++e) v[e] = wall[e];
    } else {
      const double pressing = low ? std::max(0.0, -v[d]) : std::max(0.0, v[d]);
      v[d] = 0.0;
      const double yield = kind == FaceKind::wall_law && law ? yield_force(*law, pressing) : 0.0;
      if (yield == 0.0) continue;
      double slip = 0.0;
      for (int e = 0; e < D; ++e)
        if (e != d) slip += (v[e] - wall[e]) * (v[e] - wall[e]);
      slip = std::sqrt(slip);
      const double kept = slip > 0.0 ? std::max(0.0, 1.0 - yield / slip) : 0.0;
      for (int e = 0; e < D; ++e)
        if (e != d) v[e] = wall[e] + kept * (v[e] - wall[e]);
    }
  }
}

template <int D>
Index<D> control_of(const Index<D>& block, int k) {
  Index<D> node;
  for (int d = D - 1; d >= 0; --d, k /= tile_cells) node[d] = block[d] * tile_cells - 1 + k % tile_cells;
  return node;
}

/// Makes the velocities of block b's nodes from the sums over the tiles: update(v, total, k) at its k-th node. Flat
/// walls come after it.
template <class Geometry, class Buffers, class Update>
void update_block(const Body<Geometry>& body, const WallLaw* law, const Buffers& buffers, std::size_t b,
                  ExplicitState<Geometry>& state, Update update) {
  constexpr int D = Geometry::dim;
  const NodeBlock<D>& block = state.grid.blocks[b];
  sum_tiles<D>(block, buffers, [&](int k, const f64x4& total) {
    f64x4& v = state.grid.v[b][k];
    update(v, total, static_cast<std::size_t>(k));
    if (v[D] > 0.0)
      apply_walls<D>(state.grid.axes, state.shape, body.walls, law, control_of<D>(block.at, k), v);
  });
}

/// A velocity as a node has it.
template <int D>
f64x4 to_node(const Vec<D>& v) {
  f64x4 node = {};
  for (int d = 0; d < D; ++d) node[d] = v[d];
  return node;
}

/// Velocities of block b from the momenta (with the impulses of the stresses that are in them), and gravity.
template <class Geometry, class Buffers>
void velocities_from_sums(const Body<Geometry>& body, const WallLaw* law, const Buffers& sums,
                          const Vec<Geometry::dim>& gravity_impulse, std::size_t b,
                          ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  const f64x4 pull = to_node<D>(gravity_impulse);
  update_block(body, law, sums, b, state, [&pull](f64x4& v, const f64x4& total, std::size_t) {
    const double inverse = total[D] > 0.0 ? 1.0 / total[D] : 0.0;
    v = inverse > 0.0 ? total * inverse + pull : f64x4{};
    v[D] = inverse;
  });
}

/// Adds impulses of the stresses and gravity to velocities of block b that are there already.
template <class Geometry, class Buffers>
void add_impulses(const Body<Geometry>& body, const WallLaw* law, const Buffers& impulses, bool flip,
                  const Vec<Geometry::dim>& gravity_impulse, std::size_t b, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  const f64x4 pull = to_node<D>(gravity_impulse);
  update_block(body, law, impulses, b, state, [&](f64x4& v, const f64x4& impulse, std::size_t k) {
    if (flip) state.grid.v_start[b][k] = v;
    const double inverse = v[D];
    if (inverse > 0.0) v += impulse * inverse + pull;
    v[D] = inverse;
  });
}

}  // namespace tremie::detail
