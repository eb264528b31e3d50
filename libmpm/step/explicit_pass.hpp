#pragma once

// One pass over the points of a tile: grid to points, stress, motion, points to grid, in whatever part a
// scheme asks for. Between the sums over controls, which go point by point, everything is done for eight
// points at once.

#include "libmpm/space/gradients.hpp"
#include "libmpm/step/pressure_cells.hpp"

namespace tremie::detail {

/// What a pass does. `gather`: reads velocities; `stress`: updates volume, flocculation and stress and gives
/// the controls its impulses; `move`: updates velocities and places and gives the controls mass and momentum.
struct Pass {
  bool gather = true, stress = true, move = true;
};
inline constexpr Pass whole_pass{}, first_sums{.gather = false},
    first_momenta{.gather = false, .stress = false}, stress_pass{.move = false}, motion_pass{.stress = false};

struct PassInput {
  double dt = 0.0;          ///< of the motion and of the state [s]
  double impulse_dt = 0.0;  ///< of the impulses: the step that they act in [s]
};

/// Reduced over the points of a tile, then over the tiles in their order.
struct PassSums {
  double farthest = 0.0;  ///< largest move along an axis, in cells
  double speed2 = 0.0;    ///< largest, squared [m^2/s^2]
  double volume = 0.0, volume_rate = 0.0, lambda = 0.0;
  bool ran_away = false;

  void add(const PassSums& other) {
    farthest = std::max(farthest, other.farthest), speed2 = std::max(speed2, other.speed2);
    volume += other.volume, volume_rate += other.volume_rate;
    lambda = std::max(lambda, other.lambda), ran_away = ran_away || other.ran_away;
  }
};

/// Grid fields at eight points.
template <int D>
struct Fields {
  Octet v[4] = {}, dv[4] = {}, L[D][4] = {}, moment[D][4] = {};  ///< L[b][a] = dv_a/dx_b
};

template <Wanted wanted, int D>
void gather_group(const std::array<NodeLanes, TileGrid<D>::tile_nodes>& v,
                  const std::array<NodeLanes, TileGrid<D>::tile_nodes>& dv, const Weights<D>& weights, int n,
                  bool change, Fields<D>& fields) {
  NodeLanes value[octet_size] = {}, slope[D][octet_size] = {}, moment[D][octet_size] = {},
            changed[octet_size] = {};
  for (int l = 0; l < n; ++l) {
    const auto w = of_lane<D>(weights, l);
    const int base = weights.base[static_cast<std::size_t>(l)];
    const auto at = gather<D, 3, wanted>(&v[base], w);
    value[l] = at.value;
    for (int d = 0; d < D && wanted.slopes; ++d) slope[d][l] = at.slope[d];
    for (int d = 0; d < D && wanted.moments; ++d) moment[d][l] = at.moment[d];
    if (change) changed[l] = gather<D, 3, value_only>(&dv[base], w).value;
  }
  to_columns(value, fields.v);
  for (int d = 0; d < D && wanted.slopes; ++d) to_columns(slope[d], fields.L[d]);
  for (int d = 0; d < D && wanted.moments; ++d) to_columns(moment[d], fields.moment[d]);
  if (change) to_columns(changed, fields.dv);
}

/// Reads what a pass needs. FLIP needs no moments, and a pass without stress no slopes.
template <Pass pass, int D>
void gather_for(const std::array<NodeLanes, TileGrid<D>::tile_nodes>& v,
                const std::array<NodeLanes, TileGrid<D>::tile_nodes>& dv, const Weights<D>& weights, int n,
                bool flip, Fields<D>& fields) {
  constexpr Wanted without{.slopes = pass.stress, .moments = false};
  constexpr Wanted with{.slopes = pass.stress, .moments = true};
  if (pass.move && !flip)
    gather_group<with, D>(v, dv, weights, n, false, fields);
  else
    gather_group<without, D>(v, dv, weights, n, pass.move && flip, fields);
}

/// Deviatoric stress and its hoop part, times volume; the pressure's part is added to the stress or, with one
/// row a cell, kept apart.
template <int D>
struct GroupStress {
  Octet sigma[D][D] = {}, hoop = {}, pressure = {};  ///< times volume [Pa m^3]
};

/// Updates volume and flocculation of group g over dt and returns its stress.
template <class Space, class Law>
GroupStress<Space::dim> update_state(const Mix& mix, const Law& law, bool cell_pressure, double dt,
                                     const Fields<Space::dim>& fields, const Octet& cell_divergence,
                                     LanePoints<Space::dim>& points, std::size_t g, PassSums& sums) {
  constexpr int D = Space::dim, ns = Space::n_strain;
  Octet L[D][D], q[ns], divergence, tau_y = all_lanes(mix.tau_0);
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) L[a][b] = fields.L[b][a];
  strain_rate_of<Space, Octet>(L, fields.v[0], points.x[0][g], q, divergence);
  Octet q2 = q[0] * q[0];
  for (int k = 1; k < ns; ++k) q2 += q[k] * q[k];
  const Octet gamma_dot = sqrt(q2);
  if (points.thixotropic()) {
    Octet& lambda = points.lambda[g];
    if (dt > 0.0)
      lambda = flocculation_step(lambda, *mix.thixotropy, mix.tau_0, points.gamma_dot[g], gamma_dot, dt);
    points.gamma_dot[g] = gamma_dot;
    tau_y = (1.0 + lambda) * mix.tau_0;
    sums.lambda = std::max(sums.lambda, largest(lambda));
  }
  Octet& ln_J = points.ln_J[g];
  ln_J += dt * (cell_pressure ? cell_divergence : divergence);
  const Octet volume = points.V0[g] * exp(ln_J),
              viscosity = volume * (mix.mu + secant(law, gamma_dot, tau_y));
  sums.volume += sum(volume), sums.volume_rate += sum(volume * gamma_dot);

  GroupStress<D> stress;
  stress.pressure = volume * (-mix.K * ln_J);
  for (Octet& s : q) s *= viscosity;
  const Octet in_tensor = cell_pressure ? Octet{} : stress.pressure;
  stress_tensor_of<Space, Octet>(q, in_tensor, stress.sigma, stress.hoop);
  return stress;
}

/// New velocities and places of group g.
template <int D>
void move_group(const std::array<Axis, D>& axes, const Transfer& transfer, double dt,
                const Weights<D>& weights, const Fields<D>& fields, LanePoints<D>& points, std::size_t g,
                PassSums& sums) {
  Octet speed2 = {};
  for (int d = 0; d < D; ++d) {
    Octet &v = points.v[d][g], &x = points.x[d][g];
    v = transfer.flip ? fields.v[d] + transfer.flip_blend * (v - fields.v[d] + fields.dv[d]) : fields.v[d];
    x += dt * fields.v[d];
    const Axis& a = axes[d];
    if (a.wall_low()) x = max(x, all_lanes(a.origin + 1e-6 * a.h));
    if (a.wall_high()) x = min(x, all_lanes(a.origin + a.length() - 1e-6 * a.h));
    speed2 += v * v;
    const Octet cells = (dt / a.h) * (fields.v[d] < 0.0 ? -fields.v[d] : fields.v[d]);
    for (int l = 0; l < octet_size; ++l) sums.ran_away = sums.ran_away || !(cells[l] < 0.5);
    sums.farthest = std::max(sums.farthest, largest(cells));
  }
  sums.speed2 = std::max(sums.speed2, largest(speed2));
  if (transfer.flip) return;
  for (int b = 0; b < D; ++b) {
    // On a wall one control has all the weight: no slope can be seen there, and none is given.
    const double least = 1e-12 * axes[b].h * axes[b].h;
    const Octet inverse = weights.inertia[b] > least ? 1.0 / weights.inertia[b] : Octet{};
    for (int a = 0; a < D; ++a) points.C[a * D + b][g] = fields.moment[b][a] * inverse;
  }
}

/// Momentum, mass and impulses of group g to the controls.
template <class Space>
void scatter_group(bool momentum, bool flip, bool apart, double impulse_dt,
                   const Weights<Space::dim>& weights, const GroupStress<Space::dim>& stress, int n,
                   const LanePoints<Space::dim>& points, std::size_t g,
                   std::array<NodeLanes, TileGrid<Space::dim>::tile_nodes>& sums,
                   std::array<NodeLanes, TileGrid<Space::dim>::tile_nodes>& forces) {
  constexpr int D = Space::dim;
  NodeLanes value[octet_size], slope[D][octet_size], moment[D][octet_size], pull[octet_size] = {};
  Octet column[4] = {};
  if (momentum) {
    for (int d = 0; d < D; ++d) column[d] = points.mass[g] * points.v[d][g];
    column[D] = points.mass[g];
  }
  Octet hoop[4] = {};
  if (std::is_same_v<Space, Axisymmetric>) {
    hoop[0] = -impulse_dt * stress.hoop / points.x[0][g];
    if (!apart) column[0] += hoop[0];
  }
  to_rows(column, value);
  if (apart) to_rows(hoop, pull);
  for (int b = 0; b < D; ++b) {
    Octet s[4] = {}, m[4] = {};
    for (int a = 0; a < D; ++a) {
      s[a] = -impulse_dt * stress.sigma[a][b];
      if (momentum && !flip) m[a] = points.mass[g] * points.C[a * D + b][g];
    }
    to_rows(s, slope[b]);
    to_rows(m, moment[b]);
  }
  for (int l = 0; l < n; ++l) {
    const auto w = of_lane<D>(weights, l);
    const int base = weights.base[static_cast<std::size_t>(l)];
    NodeLanes s[D], m[D];
    for (int d = 0; d < D; ++d) s[d] = slope[d][l], m[d] = moment[d][l];
    const NodeLanes none[D] = {};
    if (apart) {
      scatter<D, 3>(&sums[base], w, value[l], none, m);
      scatter<D, 3>(&forces[base], w, pull[l], s, none);
    } else {
      scatter<D, 3>(&sums[base], w, value[l], s, m);
    }
  }
}

/// One tile.
template <Pass pass, class Space, class Law>
PassSums pass_over_tile(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                        const PassInput& input, int t, ExplicitState<Space>& state) {
  constexpr int D = Space::dim;
  TileGrid<D>& grid = state.grid;
  LanePoints<D>& points = state.points;
  const Tile<D>& tile = grid.tiles[t];
  const bool flip = settings.transfer.flip, cells = settings.cell_pressure;
  const bool apart = flip && pass.move && pass.stress;  // FLIP must tell forces from momentum
  typename TileGrid<D>::Buffer v, dv;
  if (pass.gather) read_blocks<D>(tile, grid.v, v);
  if (pass.gather && pass.move && flip) read_blocks<D>(tile, grid.dv, dv);
  auto& sums = grid.sums[t];
  auto& forces = apart ? grid.forces[t] : sums;
  sums.fill(NodeLanes{});
  if (apart) forces.fill(NodeLanes{});
  const auto first = static_cast<std::size_t>(tile.first_group),
             last = static_cast<std::size_t>(tile.last_group);
  PressureCells<Space> before(grid.axes, state.shape, tile.at), after(grid.axes, state.shape, tile.at);
  PressureCells<Space>& pushed = pass.gather && pass.move ? after : before;
  static thread_local std::vector<std::array<int, octet_size>> cells_before;
  if (pass.stress && cells && pass.gather) {
    cells_before.resize(last - first);
    for (std::size_t g = first; g < last; ++g) before.add_group(points, g, cells_before[g - first]);
    before.read_divergences(v);
  }
  PassSums reduced;

  for (std::size_t g = first; g < last; ++g) {
    const int n = filled<D>(points, g);
    Weights<D> weights;
    const auto place = [&] {
      std::array<Octet, D> x;
      for (int d = 0; d < D; ++d) x[d] = points.x[d][g];
      weigh<D>(grid.axes, state.shape, tile.at, x, weights);
    };
    place();
    Fields<D> fields;
    if (pass.gather) gather_for<pass, D>(v, dv, weights, n, flip, fields);
    GroupStress<D> stress;
    std::array<int, octet_size> cell{};
    if (pass.stress) {
      Octet divergence = {};
      if (cells && pass.gather) cell = cells_before[g - first];
      for (int l = 0; l < n && cells && pass.gather; ++l)
        divergence[l] = before.divergence(cell[static_cast<std::size_t>(l)]);
      stress = update_state<Space>(mix, law, cells, input.dt, fields, divergence, points, g, reduced);
    }
    if (pass.move && pass.gather) {
      move_group<D>(grid.axes, settings.transfer, input.dt, weights, fields, points, g, reduced);
      place();
    }
    if (pass.stress && cells) {
      if (!pass.gather || pass.move) pushed.add_group(points, g, cell);
      pushed.push(cell, n, input.impulse_dt * stress.pressure);
    }
    scatter_group<Space>(pass.move, flip, apart, input.impulse_dt, weights, stress, n, points, g, sums,
                         forces);
  }
  if (pass.stress && cells) pushed.scatter_impulses(forces);
  return reduced;
}

/// All tiles.
template <Pass pass, class Space, class Law>
PassSums pass_over_points(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                          const PassInput& input, ExplicitState<Space>& state) {
  std::vector<PassSums> reduced(state.grid.tiles.size());
#pragma omp parallel for schedule(dynamic)
  for (int t = 0; t < state.grid.n_tiles(); ++t)
    reduced[t] = pass_over_tile<pass, Space>(mix, law, settings, input, t, state);
  PassSums all;
  for (const PassSums& one : reduced) all.add(one);
  return all;
}

}  // namespace tremie::detail
