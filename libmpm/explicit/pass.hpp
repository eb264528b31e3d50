#pragma once

// One pass over the points of a tile: grid to points, stress, motion, points to grid, in whatever part a
// scheme asks for. Between the sums over nodes, which go point by point, everything is done for eight
// points at once.

#include "libmpm/explicit/cell_pressures.hpp"
#include "libmpm/explicit/gather.hpp"
#include "libmpm/explicit/passes.hpp"
#include "libmpm/geometry/gradients.hpp"
#include "libmpm/transfer/single_sums.hpp"

namespace tremie::detail {

/// Strain rate of points side by side.
template <class Geometry, class Lanes>
struct StrainRate {
  Lanes q[Geometry::n_strain], divergence, gamma_dot;  ///< [1/s]
};

/// slope[b][a] = dv_a/dx_b; v_0 and x_0 the first components of velocity and place.
template <class Geometry, class Lanes, std::size_t n>
[[gnu::always_inline]] inline StrainRate<Geometry, Lanes> strain_rate(const Lanes (&slope)[Geometry::dim][n],
                                                                      const Lanes& v_0, const Lanes& x_0) {
  constexpr int D = Geometry::dim;
  Lanes L[D][D];
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) L[a][b] = slope[b][a];
  StrainRate<Geometry, Lanes> rate;
  strain_rate_of<Geometry, Lanes>(L, v_0, x_0, rate.q, rate.divergence);
  Lanes q2 = rate.q[0] * rate.q[0];
  for (int k = 1; k < Geometry::n_strain; ++k) q2 += rate.q[k] * rate.q[k];
  rate.gamma_dot = sqrt(q2);
  return rate;
}

/// Updates the flocculation of group g over dt, and gives its static yield stress [Pa].
template <int D>
f64x8 update_yield_stress(const Mix& mix, double dt, const f64x8& gamma_dot, LanePoints<D>& points,
                          std::size_t g, LaneSums& sums) {
  if (!points.thixotropic()) {
    if (!points.gamma_dot.empty()) points.gamma_dot[g] = gamma_dot;
    return all_lanes(mix.tau_0);
  }
  f64x8& lambda = points.lambda[g];
  if (dt > 0.0)
    lambda = flocculation_step(lambda, *mix.thixotropy, mix.tau_0, points.gamma_dot[g], gamma_dot, dt);
  points.gamma_dot[g] = gamma_dot;
  sums.lambda = max(sums.lambda, lambda);
  return (1.0 + lambda) * mix.tau_0;
}

/// Their secant viscosity [Pa s].
template <class Law, class Lanes>
Lanes viscosity_of(const Mix& mix, const Law& law, const Lanes& gamma_dot, const Lanes& tau_y) {
  return static_cast<ScalarOf<Lanes>>(mix.mu) + secant(law, gamma_dot, tau_y);
}

/// What eight points oppose to the flow, times volume.
struct Resistance {
  f64x8 viscosity, pressure;  ///< [Pa s m^3], [Pa m^3]
};

/// Updates volume and flocculation of group g over dt. `hold`: the volume that its viscous part is integrated
/// over, in units of the points' own.
template <int D, class Law>
Resistance update_state(const Mix& mix, const Law& law, double dt, const f64x8& gamma_dot,
                        const f64x8& divergence, const f64x8& hold, LanePoints<D>& points, std::size_t g,
                        LaneSums& sums) {
  const f64x8 tau_y = update_yield_stress(mix, dt, gamma_dot, points, g, sums);
  f64x8& ln_J = points.ln_J[g];
  ln_J += dt * divergence;
  const f64x8 volume = points.V0[g] * exp(ln_J);
  sums.volume += volume, sums.volume_rate += volume * gamma_dot;
  return {hold * volume * viscosity_of(mix, law, gamma_dot, tau_y), volume * (-mix.K * ln_J)};
}

/// Stress and its hoop part, times volume, without the pressure where that goes by the cell.
template <int D, class Lanes>
struct LaneStress {
  Lanes sigma[D][D], hoop;  ///< [Pa m^3]
};

template <class Geometry, class Lanes>
LaneStress<Geometry::dim, Lanes> stress_of(const StrainRate<Geometry, Lanes>& rate, const Lanes& viscosity,
                                           const Lanes& pressure) {
  Lanes s[Geometry::n_strain];
  for (int k = 0; k < Geometry::n_strain; ++k) s[k] = rate.q[k] * viscosity;
  LaneStress<Geometry::dim, Lanes> stress;
  stress_tensor_of<Geometry, Lanes>(s, pressure, stress.sigma, stress.hoop);
  return stress;
}

/// 1/inertia in each direction [1/m^2], by one division. On a wall one node has all the weight: no slope
/// can be seen there, and none is given.
template <int D, class Lanes>
[[gnu::always_inline]] inline std::array<Lanes, D> inverse_inertia(const StencilFrame<D>& frame,
                                                                   const Lanes* inertia) {
  using Real = ScalarOf<Lanes>;
  const auto per_cell = [&](int d) { return static_cast<Real>(frame.axis[d].ih * frame.axis[d].ih); };
  const Lanes one = 1 - Lanes{};
  Lanes cells[D];  // in cells^2
  decltype(one > one) seen[D];
  Lanes product = one;
  for (int d = 0; d < D; ++d) {
    cells[d] = inertia[d] * per_cell(d);
    seen[d] = cells[d] > static_cast<Real>(1e-12);
    cells[d] = seen[d] ? cells[d] : one;
    product *= cells[d];
  }
  const Lanes inverse = one / product;
  std::array<Lanes, D> of;
  for (int d = 0; d < D; ++d) {
    Lanes others = inverse * per_cell(d);
    for (int e = 0; e < D; ++e)
      if (e != d) others *= cells[e];
    of[d] = seen[d] ? others : Lanes{};
  }
  return of;
}

/// Moves group g with velocities v.
template <int D>
[[gnu::always_inline]] inline void move_places(const std::array<Axis, D>& axes, const StencilFrame<D>& frame,
                                               double dt, const f64x8* v, LanePoints<D>& points,
                                               std::size_t g, LaneSums& sums) {
  f64x8 speed2 = {};
  for (int d = 0; d < D; ++d) {
    f64x8& x = points.x[d][g];
    x += dt * v[d];
    const Axis& a = axes[d];
    if (a.wall_low()) x = max(x, all_lanes(a.origin + 1e-6 * a.h));
    if (a.wall_high()) x = min(x, all_lanes(a.origin + a.length() - 1e-6 * a.h));
    speed2 += points.v[d][g] * points.v[d][g];
    const f64x8 cells = (dt * frame.axis[d].ih) * (v[d] < 0.0 ? -v[d] : v[d]);
    sums.ran_away |= ~(cells < 0.5);
    sums.farthest = max(sums.farthest, cells);
  }
  sums.speed2 = max(sums.speed2, speed2);
}

/// New velocities and places of group g. The moments of `fields` become its affine velocities, C[b][a].
template <int D>
void move_group(const std::array<Axis, D>& axes, const StencilFrame<D>& frame, const Transfer& transfer,
                double dt, const Weights<D>& weights, Fields<D>& fields, LanePoints<D>& points, std::size_t g,
                LaneSums& sums) {
  for (int d = 0; d < D; ++d) {
    f64x8& v = points.v[d][g];
    v = transfer.flip ? fields.v[d] + transfer.flip_blend * (v - fields.v_start[d]) : fields.v[d];
  }
  move_places<D>(axes, frame, dt, fields.v, points, g, sums);
  if (transfer.flip) return;
  const std::array<f64x8, D> inverse = inverse_inertia<D>(frame, weights.inertia.data());
  for (int b = 0; b < D; ++b)
    for (int a = 0; a < D; ++a) fields.moment[b][a] *= inverse[b];
  if (points.C[0].empty()) return;
  for (int b = 0; b < D; ++b)
    for (int a = 0; a < D; ++a) points.C[a * D + b][g] = fields.moment[b][a];
}

/// Momentum, mass and impulses of group g to the nodes; `forces` is `sums` unless FLIP must tell them
/// apart. affine[b][a]: its affine velocities, but with FLIP.
template <Pass pass, class Geometry>
void scatter_points(bool flip, bool apart, double impulse_dt, const Weights<Geometry::dim>& weights,
                    const LaneStress<Geometry::dim, f64x8>& stress, const f64x8 (&affine)[Geometry::dim][4],
                    int n, const LanePoints<Geometry::dim>& points, std::size_t g, Cube<Geometry::dim>& sums,
                    Cube<Geometry::dim>& forces) {
  constexpr int D = Geometry::dim;
  constexpr bool hooped = pass.stress && std::is_same_v<Geometry, Axisymmetric>;
  constexpr Given momenta{.slopes = false}, impulses{.values = hooped, .moments = false};
  constexpr Given both{.values = pass.move || hooped, .slopes = pass.stress, .moments = pass.move};
  const f64x8 mass = points.mass[g];
  Spread<D> momentum, impulse;
  Spread<D>& forced = apart ? impulse : momentum;
  for (f64x8& value : momentum.value) value = f64x8{};
  for (f64x8& value : impulse.value) value = f64x8{};
  if (pass.move) momentum.value[D] = mass;
  for (int a = 0; a < D; ++a) {
    if (pass.move) momentum.value[a] = mass * points.v[a][g];
    for (int b = 0; b < D && pass.move; ++b) momentum.moment[b][a] = flip ? f64x8{} : mass * affine[b][a];
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

/// What eight points stand for in cells at walls, where the tile has such; `cell`: theirs in the tile.
template <int D>
f64x8 hold_of_group(const HeldCells<D>* held, const std::array<int, f64x8_size>& cell) {
  f64x8 of = all_lanes(1.0);
  for (std::size_t l = 0; l < f64x8_size && held; ++l)
    of[l] = static_cast<double>((*held)[static_cast<std::size_t>(cell[l])].hold);
  return of;
}

/// Rows of nodes that the first n points of a group reach.
template <int D>
TileRows rows_reached(const Weights<D>& weights, int n) {
  TileRows rows = stencil_rows<D>(weights.base[0]);
  for (int l = 1; l < n && !weights.together; ++l)
    rows |= stencil_rows<D>(weights.base[static_cast<std::size_t>(l)]);
  return rows;
}

/// Pressure cells of a group's points.
using GroupCells = std::array<int, f64x8_size>;

/// What a pass has in hand over one tile. Node: of the nodes that the tile sees.
template <Pass pass, class Geometry, class Law, class Node>
struct TilePass {
  static constexpr int D = Geometry::dim;
  using Cube = NodeCube<Node, TileGrid<D>::tile_nodes>;

  const Mix& mix;
  const Law& law;
  const ExplicitSettings& settings;
  const PassInput& input;
  const ExplicitState<Geometry>& state;
  const Tile<D>& tile;
  LanePoints<D>& points;
  const Cube &v, &v_start;  ///< velocities, and those before the step's forces for FLIP
  Cube &sums, &forces;      ///< what points add to; the same unless FLIP must tell forces from momentum
  TileRows rows;            ///< that they have reached
  const HeldCells<D>* held;

  bool cells;  ///< pressures go by the cell, and there are any in this pass
  PressureCells<Geometry, Node>&before, &pressed;  ///< cells of the points as they were, and as they push
  const GroupCells* entered;  ///< pressure cells of each group, where `before` has been read
  const StencilFrame<D>& frame;
  LaneSums& reduced;

  void count(const Reached& reached) { rows |= reached.rows, reduced.mixed += reached.runs; }
};

/// Pressure cells of group g as it is at the start of the pass, where the pass has a use for them.
template <Pass pass, class Geometry, class Law, class Node>
GroupCells cells_of_group(const TilePass<pass, Geometry, Law, Node>& in, std::size_t g) {
  constexpr int D = Geometry::dim;
  if (in.entered) return in.entered[g - static_cast<std::size_t>(in.tile.first_group)];
  GroupCells cell{};
  using Real = typename PressureCells<Geometry, Node>::Real;
  if (in.cells || in.held) find_pressure_cells<D, Real>(in.frame, places_of<D>(in.points, g), cell);
  return cell;
}

/// The divergence that changes the volumes of group g: by the point where its pressures do not go by the
/// cell.
template <Pass pass, class Geometry, class Law, class Node>
f64x8 divergence_of_group(const TilePass<pass, Geometry, Law, Node>& in, const f64x8& by_point,
                          const GroupCells& cell) {
  if (!in.cells) return by_point;
  return pass.gather ? in.before.divergence(cell) : f64x8{};
}

/// Gives the pressures of group g to its cells, in which it is entered if it was not or has moved since.
template <Pass pass, class Geometry, class Law>
void push_cells(TilePass<pass, Geometry, Law, f64x4>& in, std::size_t g, int n, const f64x8& pressure,
                GroupCells& cell) {
  if (!pass.gather || pass.move) in.pressed.enter(in.points, g, cell);
  in.pressed.push(cell, n, in.input.impulse_dt * pressure);
}

/// Affine velocities of group g as they are kept, where move_group leaves them.
template <int D>
Fields<D> kept_affine(const LanePoints<D>& points, std::size_t g) {
  Fields<D> fields = {};
  for (int b = 0; b < D && !points.C[0].empty(); ++b)
    for (int a = 0; a < D; ++a) fields.moment[b][a] = points.C[a * D + b][g];
  return fields;
}

/// Eight points.
template <Pass pass, class Geometry, class Law>
void visit_group(TilePass<pass, Geometry, Law, f64x4>& in, std::size_t g) {
  constexpr int D = Geometry::dim;
  const bool flip = in.settings.transfer.flip;
  const int n = filled<D>(in.points, g);
  Weights<D> weights;
  const auto place = [&] {
    constexpr Wanted wanted{.slopes = pass.stress, .moments = pass.move};
    weigh<D, wanted>(in.frame, places_of<D>(in.points, g), weights);
  };
  place();
  Fields<D> fields;
  if (pass.gather)
    gather_for<pass, D>(in.v, in.v_start, weights, n, flip, fields);
  else
    fields = kept_affine(in.points, g);
  in.reduced.mixed += weights.together ? 0 : 1;
  Resistance resistance;
  LaneStress<D, f64x8> stress;
  GroupCells cell;
  if (pass.stress) {
    cell = cells_of_group(in, g);
    const auto rate = strain_rate<Geometry, f64x8>(fields.L, fields.v[0], in.points.x[0][g]);
    resistance = update_state<D>(in.mix, in.law, in.input.dt, rate.gamma_dot,
                                 divergence_of_group(in, rate.divergence, cell),
                                 hold_of_group<D>(in.held, cell), in.points, g, in.reduced);
    stress = stress_of<Geometry, f64x8>(rate, resistance.viscosity, in.cells ? f64x8{} : resistance.pressure);
  }
  if (pass.move && pass.gather) {
    move_group<D>(in.state.grid.axes, in.frame, in.settings.transfer, in.input.dt, weights, fields, in.points,
                  g, in.reduced);
    place();
  }
  if (in.cells) push_cells(in, g, n, resistance.pressure, cell);
  in.rows |= rows_reached<D>(weights, n);
  scatter_points<pass, Geometry>(flip, &in.forces != &in.sums, in.input.impulse_dt, weights, stress,
                                 fields.moment, n, in.points, g, in.sums, in.forces);
}

/// All groups of a tile.
template <Pass pass, class Geometry, class Law>
void visit_groups(TilePass<pass, Geometry, Law, f64x4>& in) {
  for (int g = in.tile.first_group; g < in.tile.last_group; ++g) visit_group(in, static_cast<std::size_t>(g));
}

/// Enters all points of the tile into their pressure cells, and reads those.
template <Pass pass, class Geometry, class Law, class Node>
void read_pressure_cells(TilePass<pass, Geometry, Law, Node>& in, std::vector<GroupCells>& of_group) {
  const auto first = static_cast<std::size_t>(in.tile.first_group);
  of_group.resize(static_cast<std::size_t>(in.tile.last_group) - first);
  for (std::size_t i = 0; i < of_group.size(); ++i) in.before.enter(in.points, first + i, of_group[i]);
  in.before.read(in.v);
  in.entered = of_group.data();
}

/// One tile.
template <Pass pass, class Node, class Geometry, class Law>
PassSums pass_over_tile(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                        const PassInput& input, std::size_t t, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  TileGrid<D>& grid = state.grid;
  const Tile<D>& tile = grid.tiles[t];
  const bool flip = settings.transfer.flip;
  auto& sums = sums_of<Node>(grid)[t];
  auto* forces = &sums;
  if constexpr (std::is_same_v<Node, f64x4>)
    if (flip && pass.move && pass.stress) forces = &grid.forces[t];
  NodeCube<Node, TileGrid<D>::tile_nodes> v, v_start;
  if (pass.gather) read_blocks<D>(tile, grid.rows[t], grid.v, v);
  if (pass.gather && pass.move && flip) read_blocks<D>(tile, grid.rows[t], grid.v_start, v_start);
  clear_rows(grid.rows[t], sums);
  if (forces != &sums) clear_rows(grid.rows[t], *forces);
  const HeldCells<D>* held = pass.stress ? state.holding.of(static_cast<int>(t)) : nullptr;
  const bool cell_pressure = pass.stress && settings.cell_pressure;
  constexpr bool pressed_anew = pass.gather && pass.move;  // by the cells that points have moved to
  const StencilFrame<D> frame = stencil_frame<D>(grid.axes, state.shape, tile.at);
  const auto no_cells = [&](bool wanted) {
    return PressureCells<Geometry, Node>(grid.axes, tile.at, frame, settings.stress, held, wanted);
  };
  PressureCells<Geometry, Node> before = no_cells(cell_pressure),
                                after = no_cells(cell_pressure && pressed_anew);
  LaneSums reduced;
  TilePass<pass, Geometry, Law, Node> in{.mix = mix,
                                         .law = law,
                                         .settings = settings,
                                         .input = input,
                                         .state = state,
                                         .tile = tile,
                                         .points = state.points,
                                         .v = v,
                                         .v_start = v_start,
                                         .sums = sums,
                                         .forces = *forces,
                                         .rows = 0,
                                         .held = held,
                                         .cells = cell_pressure,
                                         .before = before,
                                         .pressed = pressed_anew ? after : before,
                                         .entered = nullptr,
                                         .frame = frame,
                                         .reduced = reduced};
  static thread_local std::vector<GroupCells> entered;
  if (in.cells && pass.gather) read_pressure_cells(in, entered);
  visit_groups(in);
  if (in.cells) in.pressed.scatter_impulses(*forces);
  grid.rows[t] = in.rows;
  return reduced.reduced();
}

/// One tile, in the precision that is set: single goes with the stress first.
template <Pass pass, class Geometry, class Law>
PassSums pass_as_set(const Mix& mix, const Law& law, const ExplicitSettings& settings, const PassInput& input,
                     std::size_t t, ExplicitState<Geometry>& state) {
  if constexpr (!pass.stress || !pass.move)
    if (settings.single_precision)
      return pass_over_tile<pass, f32x4, Geometry>(mix, law, settings, input, t, state);
  return pass_over_tile<pass, f64x4, Geometry>(mix, law, settings, input, t, state);
}

/// A pass over the points of all tiles, with the velocities that the nodes have.
template <Pass pass, class Geometry, class Law>
PassSums pass_over_points(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                          const PassInput& input, ExplicitState<Geometry>& state) {
  std::vector<PassSums> of_tile(state.grid.tiles.size());
  for_each_tile(state.grid, [&](std::size_t t) {
    of_tile[t] = pass_as_set<pass, Geometry>(mix, law, settings, input, t, state);
  });
  PassSums all;
  for (const PassSums& one : of_tile) all.add(one);
  if (state.mixed_groups < 0) state.mixed_groups = all.mixed;
  state.mixed_since += std::max<std::int64_t>(0, all.mixed - state.mixed_groups);
  return all;
}

}  // namespace tremie::detail
