#pragma once

// Moving rigid walls in an explicit step: impulses on the nodes that keep the points next to a wall from
// coming nearer than their half spacing. One-sided, without friction.
//
// The grid's velocities themselves are held back, not the points': a point that stays while its cell's
// velocities go on would lose its volume, and with it the pressure that pushes against the wall.

#include <omp.h>

#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/explicit/state.hpp"

namespace tremie::detail {

/// A point that may touch the wall in this step.
template <int D>
struct WallPoint {
  int n = 0;  ///< nodes that it reaches
  std::array<f64x4*, power(3, D)> node;
  std::array<double, power(3, D)> N;
  std::array<f64x4, power(3, D)> push;  ///< velocity that a unit impulse along the normal gives each
  f64x4 normal = {};
  double target = 0.0;   ///< least normal velocity [m/s]
  double inertia = 0.0;  ///< 1/kg: of the nodes against an impulse along the normal
  double given = 0.0;    ///< impulse so far [N s]
};

/// Time over which a point that is too near is moved back [s]: within it at most a few millimetres are
/// missing, which must not become a push of many metres a second.
inline constexpr double wall_recovery = 0.02;

/// Sweeps over the wall's points: each hands on what its neighbours left of its approach.
inline constexpr int wall_sweeps = 3;

/// Finds the points that the wall says anything about. Points and wall may move a third of a cell, which is
/// less than how far the wall must see, before they are looked for again.
template <class Geometry>
void look_around_wall(const RigidWall<Geometry::dim>& wall, double time, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
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

/// One of a point's three nodes in a direction.
struct NodeAlong {
  int block, within;  ///< its share in the numbers of the tile's block and of the node in it
  double w;
  f64x4 kept;  ///< 1 for the components of a push that its flat walls leave, else 0
};

/// Those of lane l in direction d.
template <class Geometry>
std::array<NodeAlong, 3> nodes_along(const ExplicitState<Geometry>& state, const Tile<Geometry::dim>& tile,
                                     const Weights<double, Geometry::dim>& weights, std::size_t l, int d) {
  constexpr int D = Geometry::dim;
  const Axis& a = state.grid.axes[d];
  std::array<NodeAlong, 3> nodes;
  for (int k = 0; k < 3; ++k) {
    const int local = weights.base[l] / stride<D>(tile_span, d) % tile_span + k,
              node = tile.at[d] * tile_cells - 1 + local;
    const bool low = a.wall_low() && node == state.shape.low_wall(),
               high = a.wall_high() && node == a.n_cells + 1;
    f64x4 kept = {1.0, 1.0, 1.0, 1.0};
    if (low || high) kept[d] = 0.0;
    if ((low && a.low == FaceKind::no_slip) || (high && a.high == FaceKind::no_slip)) kept = f64x4{};
    nodes[k] = {local / tile_cells * stride<D>(2, d), local % tile_cells * stride<D>(tile_cells, d),
                weights.w[d][k][l], kept};
  }
  return nodes;
}

/// The nodes of lane l, and what a push along the normal does to them: flat walls take what goes into them.
template <class Geometry>
void enter_controls(ExplicitState<Geometry>& state, const Tile<Geometry::dim>& tile,
                    const Weights<double, Geometry::dim>& weights, std::size_t l,
                    WallPoint<Geometry::dim>& p) {
  constexpr int D = Geometry::dim;
  std::array<std::array<NodeAlong, 3>, D> along;
  for (int d = 0; d < D; ++d) along[d] = nodes_along(state, tile, weights, l, d);
  double inertia = 0.0;
  for (int i = 0; i < power(3, D); ++i) {
    int block = 0, within = 0;
    double N = 1.0;
    f64x4 normal = p.normal;
    for (int d = D - 1, rest = i; d >= 0; --d, rest /= 3) {
      const NodeAlong& at = along[d][rest % 3];
      block += at.block, within += at.within, N *= at.w, normal *= at.kept;
    }
    if (N == 0.0) continue;
    const auto b = static_cast<std::size_t>(tile.block[static_cast<std::size_t>(block)]);
    const auto k = static_cast<std::size_t>(p.n++);
    f64x4& node = state.grid.v[b][within];
    const f64x4 push = N * node[D] * normal, gain = N * push * normal;
    p.node[k] = &node, p.N[k] = N, p.push[k] = push;
    for (int d = 0; d < D; ++d) inertia += gain[d];
  }
  p.inertia = inertia;
}

/// Of the points first ... last - 1 that are near the wall those that may touch it; it must see half a cell
/// further than `gap_min`.
template <class Geometry>
std::vector<WallPoint<Geometry::dim>> find_wall_points(const RigidWall<Geometry::dim>& wall, double time,
                                                       double dt, double gap_min, std::size_t first,
                                                       std::size_t last, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  std::vector<WallPoint<D>> touching;
  const auto& axes = state.grid.axes;
  const double reach = gap_min + 0.1 * axes[0].h;
  touching.reserve(last - first);
  Weights<double, D> weights;
  int weighed = -1;
  for (std::size_t i = first; i < last; ++i) {
    const auto& [t, g, l] = state.near_wall[i];
    const Tile<D>& tile = state.grid.tiles[t];
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = state.points.x[d][g][l];
    const auto view = wall(x, time);
    if (!view || view->gap > reach) continue;
    if (weighed != g) {
      weigh<double, D>({axes, state.shape, tile.at}, places_of<D>(state.points, static_cast<std::size_t>(g)),
                       weights);
      weighed = g;
    }
    WallPoint<D>& p = touching.emplace_back();
    for (int d = 0; d < D; ++d) p.normal[d] = view->normal[d];
    const double missing = gap_min - view->gap;
    p.target =
        view->normal.dot(view->velocity) + missing / (missing > 0.0 ? std::max(dt, wall_recovery) : dt);
    enter_controls(state, tile, weights, static_cast<std::size_t>(l), p);
    if (p.inertia <= 0.0) touching.pop_back();
  }
  return touching;
}

/// Brings a point's approach to the wall to what it may be.
template <int D>
void push_off(WallPoint<D>& p) {
  f64x4 v = {};
  const auto n = static_cast<std::size_t>(p.n);
  for (std::size_t k = 0; k < n; ++k) v += p.N[k] * *p.node[k];
  double u = 0.0;
  for (int d = 0; d < D; ++d) u += p.normal[d] * v[d];
  const double total = std::max(0.0, p.given + (p.target - u) / p.inertia), more = total - p.given;
  p.given = total;
  if (more == 0.0) return;
  for (std::size_t k = 0; k < n; ++k) *p.node[k] += more * p.push[k];
}

/// Holds the concrete back at the wall at `time`, the end of a step of length dt.
template <class Geometry>
void push_off_wall(const RigidWall<Geometry::dim>& wall, double time, double dt, double gap_min,
                   ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  if (!wall) return;
  look_around_wall(wall, time, state);
  const std::size_t near = state.near_wall.size(), parts = static_cast<std::size_t>(omp_get_max_threads());
  std::vector<std::vector<WallPoint<D>>> touching(parts);
#pragma omp parallel for schedule(static)
  for (std::size_t part = 0; part < parts; ++part)
    touching[part] = find_wall_points<Geometry>(wall, time, dt, gap_min, near * part / parts,
                                                near * (part + 1) / parts, state);
  for (int sweep = 0; sweep < wall_sweeps; ++sweep)
    for (auto& part : touching)
      for (WallPoint<D>& p : part) push_off(p);
}

}  // namespace tremie::detail
