#pragma once

// Moving rigid walls in an explicit step: impulses on the controls that keep the points next to a wall from
// coming nearer than their half spacing. One-sided, without friction.
//
// The grid's velocities themselves are held back, not the points': a point that stays while its cell's
// velocities go on would lose its volume, and with it the pressure that pushes against the wall.

#include "libmpm/contact/rigid_wall.hpp"
#include "libmpm/step/explicit_body.hpp"

namespace tremie::detail {

/// A point that may touch the wall in this step.
template <int D>
struct WallPoint {
  std::array<NodeLanes*, power(3, D)> control;
  std::array<Vec<D>, power(3, D)> share;  ///< shape value times normal, zero where a flat wall holds it
  std::array<double, power(3, D)> N;
  Vec<D> normal;
  double target = 0.0;   ///< least normal velocity [m/s]
  double inertia = 0.0;  ///< 1/kg: of the controls against an impulse along the normal
};

/// Time over which a point that is too near is moved back [s]: within it at most a few millimetres are
/// missing, which must not become a push of many metres a second.
inline constexpr double wall_recovery = 0.02;

/// Sweeps over the wall's points: each hands on what its neighbours left of its approach.
inline constexpr int wall_sweeps = 3;

/// Finds the points that the wall says anything about. Points and wall may move a third of a cell, which is
/// less than how far the wall must see, before they are looked for again.
template <class Space>
void look_around_wall(const RigidWall<Space::dim>& wall, double time, ExplicitState<Space>& state) {
  constexpr int D = Space::dim;
  if (state.wall_drift < 0.3 * state.grid.axes[0].h) return;
  state.wall_drift = 0.0;
  state.near_wall.clear();
  for (int t = 0; t < state.grid.n_tiles(); ++t)
    for (int g = state.grid.tiles[t].first_group; g < state.grid.tiles[t].last_group; ++g)
      for (int l = 0; l < filled<D>(state.points, g); ++l) {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = state.points.x[d][g][l];
        if (wall(x, time)) state.near_wall.push_back({t, g, l});
      }
}

/// The points that may touch the wall, which must see half a cell further than `gap_min`.
template <class Space>
std::vector<WallPoint<Space::dim>> find_wall_points(const RigidWall<Space::dim>& wall, double time, double dt,
                                                    double gap_min, ExplicitState<Space>& state) {
  constexpr int D = Space::dim;
  std::vector<WallPoint<D>> touching;
  TileGrid<D>& grid = state.grid;
  const double reach = gap_min + 0.1 * grid.axes[0].h;
  look_around_wall(wall, time, state);
  Weights<D> weights;
  int weighed = -1;
  for (const auto& [t, g, l] : state.near_wall) {
    const Tile<D>& tile = grid.tiles[t];
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = state.points.x[d][g][l];
    const auto view = wall(x, time);
    if (!view || view->gap > reach) continue;
    if (weighed != g) {
      weigh<D>(grid.axes, state.shape, tile.at, places_of<D>(state.points, static_cast<std::size_t>(g)),
               weights);
      weighed = g;
    }
    WallPoint<D> p;
    p.normal = view->normal;
    const double missing = gap_min - view->gap;
    p.target =
        view->normal.dot(view->velocity) + missing / (missing > 0.0 ? std::max(dt, wall_recovery) : dt);
    for (int k = 0; k < power(3, D); ++k) {
      const Index<D> o = local_offset<D>(k);
      int at = weights.base[static_cast<std::size_t>(l)], block = 0, within = 0;
      Index<D> local;
      for (int d = D - 1; d >= 0; --d, at /= tile_span) local[d] = at % tile_span + o[d];
      p.N[k] = 1.0;
      for (int d = 0; d < D; ++d) {
        p.N[k] *= weights.w[d][o[d]][l];
        block = 2 * block + local[d] / tile_cells;
        within = within * tile_cells + local[d] % tile_cells;
      }
      p.control[k] = &grid.v[static_cast<std::size_t>(tile.block[block])][within];
      p.share[k] = p.N[k] * p.normal;
      for (int d = 0; d < D; ++d) {
        const Axis& a = grid.axes[d];
        const int control = tile.at[d] * tile_cells - 1 + local[d];
        const bool low = a.wall_low() && control == state.shape.low_wall();
        const bool high = a.wall_high() && control == a.n_cells + 1;
        if ((low ? a.low : a.high) == FaceKind::no_slip && (low || high)) p.share[k].setZero();
        if (low || high) p.share[k][d] = 0.0;
      }
      const double mass = (*p.control[k])[D];
      if (mass > 0.0) p.inertia += p.share[k].squaredNorm() / mass;
    }
    if (p.inertia > 0.0) touching.push_back(p);
  }
  return touching;
}

/// Holds the concrete back at the wall at `time`, the end of a step of length dt.
template <class Space>
void push_off_wall(const RigidWall<Space::dim>& wall, double time, double dt, double gap_min,
                   ExplicitState<Space>& state) {
  constexpr int D = Space::dim;
  if (!wall) return;
  auto touching = find_wall_points<Space>(wall, time, dt, gap_min, state);
  std::vector<double> given(touching.size(), 0.0);
  for (int sweep = 0; sweep < wall_sweeps; ++sweep)
    for (std::size_t i = 0; i < touching.size(); ++i) {
      WallPoint<D>& p = touching[i];
      double u = 0.0;
      for (int k = 0; k < power(3, D); ++k)
        for (int d = 0; d < D; ++d) u += p.N[k] * p.normal[d] * (*p.control[k])[d];
      const double total = std::max(0.0, given[i] + (p.target - u) / p.inertia), more = total - given[i];
      given[i] = total;
      if (more == 0.0) continue;
      for (int k = 0; k < power(3, D); ++k) {
        const double mass = (*p.control[k])[D];
        if (mass > 0.0)
          for (int d = 0; d < D; ++d) (*p.control[k])[d] += more / mass * p.share[k][d];
      }
    }
}

}  // namespace tremie::detail
