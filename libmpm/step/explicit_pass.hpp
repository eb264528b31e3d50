#pragma once

// One pass over the points of a tile: grid to points, stress, motion, points to grid, in whatever part a
// scheme asks for. Between the sums over controls, which go point by point, everything is done for eight
// points at once.

#include "libmpm/space/gradients.hpp"
#include "libmpm/step/explicit_gather.hpp"
#include "libmpm/step/pressure_cells.hpp"

namespace tremie::detail {

/// Deviatoric stress and its hoop part, times volume; the pressure's part is added to the stress or, with one
/// row a cell, kept apart.
template <int D>
struct GroupStress {
  Octet sigma[D][D] = {}, hoop = {}, pressure = {};  ///< times volume [Pa m^3]
};

/// Updates volume and flocculation of group g over dt and returns its stress. `hold`: the volume that its
/// viscous part is integrated over, in units of the points' own.
template <class Space, class Law>
GroupStress<Space::dim> update_state(const Mix& mix, const Law& law, bool cell_pressure, double dt,
                                     const Fields<Space::dim>& fields, const Octet& cell_divergence,
                                     const Octet& hold, LanePoints<Space::dim>& points, std::size_t g,
                                     LaneSums& sums) {
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
    sums.lambda = max(sums.lambda, lambda);
  }
  Octet& ln_J = points.ln_J[g];
  ln_J += dt * (cell_pressure ? cell_divergence : divergence);
  const Octet volume = points.V0[g] * exp(ln_J),
              viscosity = hold * volume * (mix.mu + secant(law, gamma_dot, tau_y));
  sums.volume += volume, sums.volume_rate += volume * gamma_dot;

  GroupStress<D> stress;
  stress.pressure = volume * (-mix.K * ln_J);
  for (Octet& s : q) s *= viscosity;
  const Octet in_tensor = cell_pressure ? Octet{} : stress.pressure;
  stress_tensor_of<Space, Octet>(q, in_tensor, stress.sigma, stress.hoop);
  return stress;
}

/// 1/inertia in each direction [1/m^2], by one division. On a wall one control has all the weight: no slope
/// can be seen there, and none is given.
template <int D>
std::array<Octet, D> inverse_inertia(const std::array<Axis, D>& axes, const Weights<D>& weights) {
  std::array<Octet, D> cells;  // in cells^2
  OctetMask seen[D];
  Octet product = all_lanes(1.0);
  for (int d = 0; d < D; ++d) {
    cells[d] = weights.inertia[d] * (1.0 / (axes[d].h * axes[d].h));
    seen[d] = cells[d] > 1e-12;
    cells[d] = seen[d] ? cells[d] : all_lanes(1.0);
    product *= cells[d];
  }
  const Octet inverse = 1.0 / product;
  std::array<Octet, D> of;
  for (int d = 0; d < D; ++d) {
    Octet others = inverse * (1.0 / (axes[d].h * axes[d].h));
    for (int e = 0; e < D; ++e)
      if (e != d) others *= cells[e];
    of[d] = seen[d] ? others : Octet{};
  }
  return of;
}

/// New velocities and places of group g.
template <int D>
void move_group(const std::array<Axis, D>& axes, const Transfer& transfer, double dt,
                const Weights<D>& weights, const Fields<D>& fields, LanePoints<D>& points, std::size_t g,
                LaneSums& sums) {
  Octet speed2 = {};
  for (int d = 0; d < D; ++d) {
    Octet &v = points.v[d][g], &x = points.x[d][g];
    v = transfer.flip ? fields.v[d] + transfer.flip_blend * (v - fields.v_start[d]) : fields.v[d];
    x += dt * fields.v[d];
    const Axis& a = axes[d];
    if (a.wall_low()) x = max(x, all_lanes(a.origin + 1e-6 * a.h));
    if (a.wall_high()) x = min(x, all_lanes(a.origin + a.length() - 1e-6 * a.h));
    speed2 += v * v;
    const Octet cells = (dt / a.h) * (fields.v[d] < 0.0 ? -fields.v[d] : fields.v[d]);
    sums.ran_away |= ~(cells < 0.5);
    sums.farthest = max(sums.farthest, cells);
  }
  sums.speed2 = max(sums.speed2, speed2);
  if (transfer.flip) return;
  const std::array<Octet, D> inverse = inverse_inertia<D>(axes, weights);
  for (int b = 0; b < D; ++b)
    for (int a = 0; a < D; ++a) points.C[a * D + b][g] = fields.moment[b][a] * inverse[b];
}

/// Momentum, mass and impulses of group g to the controls; `forces` is `sums` unless FLIP must tell them
/// apart.
template <Pass pass, class Space>
void scatter_points(bool flip, bool apart, double impulse_dt, const Weights<Space::dim>& weights,
                    const GroupStress<Space::dim>& stress, int n, const LanePoints<Space::dim>& points,
                    std::size_t g, Cube<Space::dim>& sums, Cube<Space::dim>& forces) {
  constexpr int D = Space::dim;
  constexpr bool hooped = pass.stress && std::is_same_v<Space, Axisymmetric>;
  constexpr Given momenta{.slopes = false}, impulses{.values = hooped, .moments = false};
  constexpr Given both{.values = pass.move || hooped, .slopes = pass.stress, .moments = pass.move};
  const Octet mass = points.mass[g];
  Spread<D> momentum, impulse;
  Spread<D>& forced = apart ? impulse : momentum;
  for (Octet& value : momentum.value) value = Octet{};
  for (Octet& value : impulse.value) value = Octet{};
  if (pass.move) momentum.value[D] = mass;
  for (int a = 0; a < D; ++a) {
    if (pass.move) momentum.value[a] = mass * points.v[a][g];
    for (int b = 0; b < D && pass.move; ++b)
      momentum.moment[b][a] = flip ? Octet{} : mass * points.C[a * D + b][g];
    for (int b = 0; b < D && pass.stress; ++b) forced.slope[b][a] = -impulse_dt * stress.sigma[a][b];
  }
  if (hooped) forced.value[0] += -impulse_dt * stress.hoop / points.x[0][g];
  if (apart) {
    scatter_group<D, momenta>(weights, momentum, n, sums.data());
    scatter_group<D, impulses>(weights, impulse, n, forces.data());
  } else {
    scatter_group<D, both>(weights, momentum, n, sums.data());
  }
}

/// What eight points stand for in cells at walls; `cell`: theirs in the tile.
template <int D>
Octet hold_of_group(const HeldCells<D>& held, const std::array<int, octet_size>& cell) {
  Octet of;
  for (std::size_t l = 0; l < octet_size; ++l)
    of[l] = static_cast<double>(held[static_cast<std::size_t>(cell[l])].hold);
  return of;
}

/// Rows of controls that the first n points of a group reach.
template <int D>
TileRows rows_reached(const Weights<D>& weights, int n) {
  TileRows rows = stencil_rows<D>(weights.base[0]);
  for (int l = 1; l < n && !weights.together; ++l)
    rows |= stencil_rows<D>(weights.base[static_cast<std::size_t>(l)]);
  return rows;
}

/// One tile.
template <Pass pass, class Space, class Law>
PassSums pass_over_tile(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                        const PassInput& input, int t, const Share<Space::dim>& share,
                        ExplicitState<Space>& state) {
  constexpr int D = Space::dim;
  TileGrid<D>& grid = state.grid;
  LanePoints<D>& points = state.points;
  const Tile<D>& tile = grid.tiles[t];
  const bool flip = settings.transfer.flip, cells = settings.cell_pressure;
  const bool apart = flip && pass.move && pass.stress;  // FLIP must tell forces from momentum
  Cube<D> v, v_start;
  const TileRows reached = grid.rows[grid.filled_buffer(t)];
  if (pass.gather) read_blocks<D>(tile, reached, share.v, v);
  if (pass.gather && pass.move && flip) read_blocks<D>(tile, reached, share.v_start, v_start);
  const int buffer = tile.buffer[1 - grid.turn];
  auto& sums = grid.sums[buffer];
  auto& forces = apart ? grid.forces[buffer] : sums;
  TileRows& rows = grid.rows[buffer];
  clear_rows<D>(rows, sums);
  if (apart) clear_rows<D>(rows, forces);
  rows = 0;
  const auto first = static_cast<std::size_t>(tile.first_group),
             last = static_cast<std::size_t>(tile.last_group);
  const HeldCells<D>* held = pass.stress ? state.holding.of(t) : nullptr;
  const bool pressed_anew = pass.gather && pass.move;  // by the cells that the points have moved to
  PressureCells<Space> before(grid.axes, state.shape, tile.at, settings.stress, held, pass.stress && cells),
      after(grid.axes, state.shape, tile.at, settings.stress, held, pass.stress && cells && pressed_anew);
  PressureCells<Space>& pushed = pressed_anew ? after : before;
  static thread_local std::vector<std::array<int, octet_size>> cells_before;
  if (pass.stress && cells && pass.gather) {
    cells_before.resize(last - first);
    for (std::size_t g = first; g < last; ++g) before.add_group(points, g, cells_before[g - first]);
    before.read_divergences(v);
  }
  LaneSums reduced;
  const StencilFrame<D> frame = stencil_frame<D>(grid.axes, state.shape, tile.at);

  for (std::size_t g = first; g < last; ++g) {
    const int n = filled<D>(points, g);
    Weights<D> weights;
    const auto place = [&] {
      constexpr Wanted wanted{.slopes = pass.stress, .moments = pass.move};
      weigh<D, wanted>(frame, places_of<D>(points, g), weights);
    };
    place();
    Fields<D> fields;
    if (pass.gather) gather_for<pass, D>(v, v_start, weights, n, flip, fields);
    reduced.mixed += weights.together ? 0 : 1;
    GroupStress<D> stress;
    std::array<int, octet_size> cell{};
    if (pass.stress) {
      Octet divergence = {};
      if (cells && pass.gather) cell = cells_before[g - first];
      for (int l = 0; l < n && cells && pass.gather; ++l)
        divergence[l] = before.divergence(cell[static_cast<std::size_t>(l)]);
      Octet hold = all_lanes(1.0);
      if (held) {
        if (!cells || !pass.gather)
          find_pressure_cells<D>(grid.axes, state.shape, tile.at, places_of<D>(points, g), cell);
        hold = hold_of_group<D>(*held, cell);
      }
      stress = update_state<Space>(mix, law, cells, input.dt, fields, divergence, hold, points, g, reduced);
    }
    if (pass.move && pass.gather) {
      move_group<D>(grid.axes, settings.transfer, input.dt, weights, fields, points, g, reduced);
      place();
    }
    if (pass.stress && cells) {
      if (!pass.gather || pass.move) pushed.add_group(points, g, cell);
      pushed.push(cell, n, input.impulse_dt * stress.pressure);
    }
    rows |= rows_reached<D>(weights, n);
    scatter_points<pass, Space>(flip, apart, input.impulse_dt, weights, stress, n, points, g, sums, forces);
  }
  if (pass.stress && cells) pushed.scatter_impulses(forces);
  return reduced.reduced();
}

/// All tiles; `before(share)` comes first in each share, for what needs nothing of the others but the sums of
/// the last pass.
template <Pass pass, class Space, class Law, class Before>
PassSums pass_over_points(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                          const PassInput& input, ExplicitState<Space>& state, Before before) {
  constexpr int D = Space::dim;
  std::vector<PassSums> reduced(state.grid.tiles.size());
  for_each_share(state.grid, [&](Share<D>& share) {
    before(share);
    for (int t = share.first_tile; t < share.last_tile; ++t)
      reduced[t] = pass_over_tile<pass, Space>(mix, law, settings, input, t, share, state);
  });
  state.grid.turn = 1 - state.grid.turn;
  PassSums all;
  for (const PassSums& one : reduced) all.add(one);
  state.mixed_since += std::max<std::int64_t>(0, all.mixed - state.mixed_groups);
  return all;
}

template <Pass pass, class Space, class Law>
PassSums pass_over_points(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                          const PassInput& input, ExplicitState<Space>& state) {
  return pass_over_points<pass, Space>(mix, law, settings, input, state, [](Share<Space::dim>&) {});
}

}  // namespace tremie::detail
