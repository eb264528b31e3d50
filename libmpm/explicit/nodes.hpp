#pragma once

// What happens on the nodes of an explicit step: sums of the tiles, gravity, flat walls.

#include "libmpm/explicit/body.hpp"

namespace tremie::detail {

/// Flat walls on one node, v its velocity before them. A wall takes the velocity towards it; friction
/// takes up to the coefficient times that from the sliding.
template <int D>
void apply_walls(const std::array<Axis, D>& axes, const Shape<D>& shape, const WallVelocities<D>& walls,
                 double friction_coefficient, const Index<D>& node, f64x4& v) {
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
      if (kind != FaceKind::friction || friction_coefficient * pressing == 0.0) continue;
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
Index<D> control_of(const Index<D>& block, int k) {
  Index<D> node;
  for (int d = D - 1; d >= 0; --d, k /= tile_cells) node[d] = block[d] * tile_cells - 1 + k % tile_cells;
  return node;
}

/// Which nodes of the block at `block` lie on flat walls.
template <int D>
std::uint64_t nodes_on_walls(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& block) {
  std::uint64_t on_walls = 0;
  for (int k = 0; k < power(tile_cells, D); ++k) {
    const Index<D> node = control_of<D>(block, k);
    for (int d = 0; d < D; ++d)
      if ((axes[d].wall_low() && node[d] == shape.low_wall()) ||
          (axes[d].wall_high() && node[d] == axes[d].n_cells + 1))
        on_walls |= std::uint64_t{1} << k;
  }
  return on_walls;
}

/// Makes the velocities of block b's nodes from the sums over the tiles: `update(totals, at)` those of the
/// four nodes from number `at` of the block on. Flat walls come after it.
template <class Geometry, class Buffer, class Update>
void update_block(const Body<Geometry>& body, double friction_coefficient, const std::vector<Buffer>& buffers,
                  std::size_t b, ExplicitState<Geometry>& state, Update update) {
  constexpr int D = Geometry::dim;
  TileGrid<D>& grid = state.grid;
  const NodeBlock<D>& block = grid.blocks[b];
  sum_tiles<D>(grid, block, buffers, [&](int row, const FourNodes& total) {
    const int first = row * tile_cells;
    f64x4* const v = &grid.v[b][static_cast<std::size_t>(first)];
    update(total, static_cast<std::size_t>(first));
    for (std::uint64_t on_walls = block.on_walls >> first & 0xf; on_walls != 0; on_walls &= on_walls - 1) {
      const int i = __builtin_ctzll(on_walls);
      if (v[i][D] > 0.0)
        apply_walls<D>(grid.axes, state.shape, body.walls, friction_coefficient,
                       control_of<D>(block.at, first + i), v[i]);
    }
  });
}

/// 1/mass of two nodes, which their velocities have in entry D, in all their entries.
template <int D>
two_f64x4 inverse_mass_of(const two_f64x4& two) {
  return __builtin_shufflevector(two, two, D, D, D, D, D + 4, D + 4, D + 4, D + 4);
}

/// Velocities, and 1/mass in its place.
template <int D>
two_f64x4 with_mass(const two_f64x4& v, const two_f64x4& inverse_mass) {
  if constexpr (D == 3)
    return __builtin_shufflevector(v, inverse_mass, 0, 1, 2, 8, 4, 5, 6, 12);
  else
    return __builtin_shufflevector(v, inverse_mass, 0, 1, 8, 3, 4, 5, 12, 7);
}

/// 1/mass of four nodes in all their entries, 0 where there is none.
template <int D>
FourNodes inverse_masses(const FourNodes& total) {
  const f64x4 mass = __builtin_shufflevector(total.low, total.high, D, D + 4, D + 8, D + 12);
  const auto there = mass > 0.0;
  const f64x4 inverse = there ? 1.0 / (there ? mass : f64x4{} + 1.0) : f64x4{};
  return {__builtin_shufflevector(inverse, inverse, 0, 0, 0, 0, 1, 1, 1, 1),
          __builtin_shufflevector(inverse, inverse, 2, 2, 2, 2, 3, 3, 3, 3)};
}

/// The same for two nodes.
template <int D>
two_f64x4 for_two(const Vec<D>& a) {
  f64x4 one = {};
  for (int d = 0; d < D; ++d) one[d] = a[d];
  return both(one, one);
}

/// Velocities of block b from the momenta (with the impulses of the stresses already in them), and gravity.
template <class Geometry>
void velocities_from_sums(const Body<Geometry>& body, double friction,
                          const Vec<Geometry::dim>& gravity_impulse, std::size_t b,
                          ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  const two_f64x4 pull = for_two<D>(gravity_impulse);
  const auto velocity = [&pull](const two_f64x4& total, const two_f64x4& inverse) {
    const two_f64x4 moving = total * inverse + pull;
    return with_mass<D>(inverse > 0.0 ? moving : two_f64x4{}, inverse);
  };
  const auto divide = [&](const FourNodes& total, std::size_t at) {
    const FourNodes inverse = inverse_masses<D>(total);
    store_row({velocity(total.low, inverse.low), velocity(total.high, inverse.high)}, &state.grid.v[b][at]);
  };
  if (state.grid.single)
    update_block(body, friction, state.grid.single_sums, b, state, divide);
  else
    update_block(body, friction, state.grid.sums, b, state, divide);
}

/// Adds impulses of the stresses and gravity to velocities of block b that are there already.
template <class Geometry, class Buffer>
void add_impulses(const Body<Geometry>& body, double friction, const std::vector<Buffer>& impulses, bool flip,
                  const Vec<Geometry::dim>& gravity_impulse, std::size_t b, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  const two_f64x4 pull = for_two<D>(gravity_impulse);
  const auto faster = [&pull](const two_f64x4& v, const two_f64x4& impulse) {
    const two_f64x4 inverse = inverse_mass_of<D>(v), moving = v + (impulse * inverse + pull);
    return with_mass<D>(inverse > 0.0 ? moving : v, inverse);
  };
  const auto add = [&](const FourNodes& total, std::size_t at) {
    const FourNodes v = load_row(&state.grid.v[b][at]);
    if (flip) store_row(v, &state.grid.v_start[b][at]);
    store_row({faster(v.low, total.low), faster(v.high, total.high)}, &state.grid.v[b][at]);
  };
  update_block(body, friction, impulses, b, state, add);
}

}  // namespace tremie::detail
