#pragma once

// One pass over the points: grid to points, stress, motion, points to grid, in whatever part a scheme asks for.
// Shape functions and sums over nodes are computed in Real; places, volumes, flocculation and the law in double
// precision.

#include "libmpm/constitutive/flocculation.hpp"
#include "libmpm/explicit/cell_pressures.hpp"
#include "libmpm/geometry/gradients.hpp"

namespace tremie::detail {

/// What a pass does. `gather`: reads velocities; `stress`: updates volume, flocculation and stress and gives
/// the nodes its impulses; `move`: updates velocities and places and gives the nodes mass and momentum.
struct Pass {
  bool gather = true, stress = true, move = true;
};
inline constexpr Pass whole_pass{}, first_sums{.gather = false},
    first_momenta{.gather = false, .stress = false}, stress_pass{.move = false}, motion_pass{.stress = false};

struct PassInput {
  double dt = 0.0;          ///< of the motion and of the state [s]
  double impulse_dt = 0.0;  ///< of the impulses: the step that they act in [s]
};

/// Reduced over the groups of a tile, lane by lane, then over the tiles in their order.
struct PassSums {
  f64x8 farthest = {};  ///< largest move along an axis, in cells
  f64x8 speed2 = {};    ///< largest, squared [m^2/s^2]
  f64x8 volume = {}, volume_rate = {}, lambda = {};
  i64x8 ran_away = {};

  void add(const PassSums& other) {
    farthest = max(farthest, other.farthest), speed2 = max(speed2, other.speed2);
    volume += other.volume, volume_rate += other.volume_rate;
    lambda = max(lambda, other.lambda), ran_away |= other.ran_away;
  }
};

/// What a pass has in hand over one tile.
template <class Real, class Geometry>
struct TilePass {
  static constexpr int D = Geometry::dim;

  const Mix& mix;
  const YieldLaw& law;
  const ExplicitSettings& settings;
  const PassInput& input;
  const Tile<D>& tile;
  const std::array<Axis, D>& axes;
  const StencilFrame<Real, D>& frame;
  LanePoints<D>& points;
  const NodeCube<Real, D>&v, &v_start;  ///< velocities, and those before the step's forces for FLIP
  NodeCube<Real, D>&sums, &impulses;    ///< what points add to; the same unless FLIP must tell them apart
  const HeldCells<D>* held;             ///< its cells at walls that hold
  bool cells;                           ///< pressures go by the cell, and there are any in this pass
  const GroupCells* cell;               ///< of each group as it was, where `cells` or `held` needs them
  PressureCells<Real, Geometry>&before, &pressed;  ///< cells of the points as they were, and as they push
  PassSums& reduced;

  GroupCells cells_of(std::size_t g) const {
    return cell ? cell[g - static_cast<std::size_t>(tile.first_group)] : GroupCells{};
  }
};

/// Updates the flocculation of group g over dt, and gives its static yield stress [Pa].
template <int D>
f64x8 update_yield_stress(const Mix& mix, double dt, const f64x8& gamma_dot, LanePoints<D>& points,
                          std::size_t g, PassSums& sums) {
  if (!points.thixotropic()) {
    if (!points.gamma_dot.empty()) points.gamma_dot[g] = gamma_dot;
    return all_lanes(mix.tau_0);
  }
  f64x8& lambda = points.lambda[g];
  if (dt > 0.0 && points.lambda_parts.empty())
    lambda = flocculation_step(lambda, *mix.thixotropy, mix.tau_0, points.gamma_dot[g], gamma_dot, dt);
  // By its address: clang binds no reference to an element of a whole register.
  const auto part = [&](std::size_t i) { return reinterpret_cast<double*>(&points.lambda_parts[i][g]); };
  for (int l = 0; dt > 0.0 && !points.lambda_parts.empty() && l < f64x8_size; ++l)
    lambda[l] = flocculation_step(lambda[l], *mix.thixotropy, mix.tau_0, points.gamma_dot[g][l], gamma_dot[l],
                                  dt, [&](std::size_t i) -> double& { return part(i)[l]; });
  points.gamma_dot[g] = gamma_dot;
  sums.lambda = max(sums.lambda, lambda);
  return (1.0 + lambda) * mix.tau_0;
}

/// What eight points stand for in cells at walls, in units of their volume; `cell`: theirs in the tile.
template <int D>
f64x8 represented_volumes(const HeldCells<D>* held, const GroupCells& cell) {
  f64x8 of = all_lanes(1.0);
  for (std::size_t l = 0; l < cell.size() && held; ++l) of[l] = static_cast<double>((*held)[cell[l]].hold);
  return of;
}

/// One vector a component, in each direction.
template <class Real, int D>
using Along = SimdOf<Real>[D][4];

/// Stress update of group g: volume, flocculation, and what its stress pushes with, `impulse`. slope[b][a] = dv_a/dx_b; v_0:
/// first component of the velocity. Where pressures go by the cell, they are not in the stress. Gives the hoop stress.
template <class Real, class Geometry>
f64x8 update_stress(TilePass<Real, Geometry>& in, std::size_t g, const SimdOf<Real>& v_0,
                    const Along<Real, Geometry::dim>& slope, Along<Real, Geometry::dim>& impulse,
                    f64x8& pressure) {
  constexpr int D = Geometry::dim, ns = Geometry::n_strain;
  LanePoints<D>& points = in.points;
  f64x8 L[D][D], q[ns], divergence;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) L[a][b] = to_double(slope[b][a]);
  strain_rate_of<Geometry, f64x8>(L, to_double(v_0), points.x[0][g], q, divergence);
  f64x8 q2 = q[0] * q[0];
  for (int k = 1; k < ns; ++k) q2 += q[k] * q[k];
  const f64x8 gamma_dot = sqrt(q2);
  const f64x8 tau_y = update_yield_stress<D>(in.mix, in.input.dt, gamma_dot, points, g, in.reduced);

  const GroupCells cell = in.cells_of(g);
  points.ln_J[g] += in.input.dt * (in.cells ? in.before.divergence(cell) : divergence);
  const f64x8 volume = points.V0[g] * exp(points.ln_J[g]);
  in.reduced.volume += volume, in.reduced.volume_rate += volume * gamma_dot;
  pressure = volume * (-in.mix.K * points.ln_J[g]);
  const f64x8 viscosity =
      represented_volumes<D>(in.held, cell) * volume * (in.mix.mu + secant(in.law, gamma_dot, tau_y));

  f64x8 sigma[D][D], hoop;
  for (f64x8& component : q) component *= viscosity;
  stress_tensor_of<Geometry, f64x8>(q, in.cells ? f64x8{} : pressure, sigma, hoop);
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) impulse[b][a] = to_real<Real>(-in.input.impulse_dt * sigma[a][b]);
  return hoop;
}

/// Moves group g with the velocities that it has read. Walls keep the points.
template <class Real, class Geometry>
void move_points(TilePass<Real, Geometry>& in, std::size_t g, const SimdOf<Real> (&read)[4],
                 const SimdOf<Real> (&start)[4]) {
  constexpr int D = Geometry::dim;
  const Transfer& transfer = in.settings.transfer;
  f64x8 speed2 = {};
  for (int d = 0; d < D; ++d) {
    f64x8 &x = in.points.x[d][g], &v = in.points.v[d][g];
    const f64x8 grid_v = to_double(read[d]);
    v = transfer.flip ? grid_v + transfer.flip_blend * (v - to_double(start[d])) : grid_v;
    x += in.input.dt * grid_v;
    const Axis& a = in.axes[d];
    if (a.wall_low()) x = max(x, all_lanes(a.origin + 1e-6 * a.h));
    if (a.wall_high()) x = min(x, all_lanes(a.origin + a.length() - 1e-6 * a.h));
    speed2 += v * v;
    const f64x8 cells = (in.input.dt / a.h) * max(grid_v, -grid_v);
    in.reduced.ran_away |= ~(cells < 0.5);
    in.reduced.farthest = max(in.reduced.farthest, cells);
  }
  in.reduced.speed2 = max(in.reduced.speed2, speed2);
}

/// Moments about the points to affine velocities, C[a][b] in C[b][a]; none with FLIP. On a wall one node has all the
/// weight: no slope can be seen there, and none is given.
template <class Real, class Geometry>
void affine_from_moments(TilePass<Real, Geometry>& in, std::size_t g,
                         const Weights<Real, Geometry::dim>& weights, Along<Real, Geometry::dim>& C) {
  constexpr int D = Geometry::dim;
  using V = SimdOf<Real>;
  for (int b = 0; b < D; ++b) {
    const Real h = in.frame.axis[b].h;
    const auto seen = weights.inertia[b] > static_cast<Real>(1e-12) * h * h;
    const V one = 1 - V{}, inverse = in.settings.transfer.flip
                                         ? V{}
                                         : select(seen, 1 / select(seen, weights.inertia[b], one), V{});
    for (int a = 0; a < D; ++a) {
      C[b][a] *= inverse;
      if (!in.points.C[0].empty()) in.points.C[a * D + b][g] = to_double(C[b][a]);
    }
  }
}

/// Slopes of the weights for stresses, arms for motion.
template <Pass pass, class Real, int D>
auto other_weights(const Weights<Real, D>& weights) {
  if constexpr (pass.stress && pass.move)
    return OtherWeights<Real, 2>{weights.dw, weights.wa};
  else
    return OtherWeights<Real, 1>{pass.stress ? weights.dw : weights.wa};
}

/// What update_stress and the motion do not write.
template <class Real, int D, int N>
void clear_unused(AtPoints<Real, D, N>& given) {
  for (SimdOf<Real>& value : given.value) value = SimdOf<Real>{};
  for (auto& of_set : given.along)
    for (auto& along : of_set)
      for (int c = D; c < 4; ++c) along[c] = SimdOf<Real>{};
}

/// Eight points: the material point method from top to bottom.
template <Pass pass, class Real, class Geometry>
void visit_group(TilePass<Real, Geometry>& in, std::size_t g) {
  constexpr int D = Geometry::dim, sets = pass.stress && pass.move ? 2 : 1;
  LanePoints<D>& points = in.points;
  const int n = filled<D>(points, g);
  Weights<Real, D> weights;
  const auto a = other_weights<pass>(weights);
  const bool apart = &in.impulses != &in.sums;
  AtPoints<Real, D, sets> read, start, given, forced;
  if (!pass.gather) read = {};  // no velocities: no rates
  if (apart)
    given = forced = {};
  else
    clear_unused(given);
  AtPoints<Real, D, sets>& impulses = apart ? forced : given;
  auto &C = read.along[sets - 1], &momenta = given.along[sets - 1];  // in the order of other_weights
  f64x8 pressure = {}, hoop = {};
  weigh<Real, D, pass.stress, pass.move>(in.frame, places_of<D>(points, g), weights);
  // Grid to points.
  if (pass.gather) gather<Real, D, sets>(in.v, weights, a, read);
  if (pass.gather && pass.move && in.settings.transfer.flip)
    gather<Real, D, sets>(in.v_start, weights, a, start);
  // Stress.
  if (pass.stress)
    hoop = update_stress<Real, Geometry>(in, g, read.value[0], read.along[0], impulses.along[0], pressure);
  // Motion.
  if (pass.gather && pass.move) {
    move_points<Real, Geometry>(in, g, read.value, start.value);
    affine_from_moments<Real, Geometry>(in, g, weights, C);
    weigh<Real, D, pass.stress, pass.move>(in.frame, places_of<D>(points, g), weights);
  } else if (pass.move) {
    for (int b = 0; b < D; ++b)
      for (int i = 0; i < D; ++i)
        C[b][i] = points.C[0].empty() ? SimdOf<Real>{} : to_real<Real>(points.C[i * D + b][g]);
  }
  // Points to grid: pressures, the other stresses, mass and momentum.
  if (in.cells) {
    const GroupCells cell = pass.gather && pass.move ? cells_of_group(in.frame, points, g) : in.cells_of(g);
    if (pass.move) in.pressed.enter(points, g, cell);
    in.pressed.push(cell, n, in.input.impulse_dt * pressure);
  }
  if (std::is_same_v<Geometry, Axisymmetric>)
    impulses.value[0] = to_real<Real>(-in.input.impulse_dt * hoop / points.x[0][g]);
  if (apart || !pass.move) scatter<Real, D, sets>(weights, a, impulses, n, in.impulses);
  if (!pass.move) return;
  const SimdOf<Real> mass = given.value[D] = to_real<Real>(points.mass[g]);
  for (int i = 0; i < D; ++i) {
    given.value[i] += mass * to_real<Real>(points.v[i][g]);
    for (int b = 0; b < D; ++b) momenta[b][i] = mass * C[b][i];
  }
  scatter<Real, D, sets>(weights, a, given, n, in.sums);
}

/// One tile.
template <Pass pass, class Real, class Geometry>
PassSums pass_over_tile(const Mix& mix, const YieldLaw& law, const ExplicitSettings& settings,
                        const PassInput& input, std::size_t t, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  using Buffers = typename TileGrid<D>::template Buffers<Real>;
  TileGrid<D>& grid = state.grid;
  const Tile<D>& tile = grid.tiles[t];
  const bool flip = settings.transfer.flip && pass.move, apart = flip && pass.stress;
  NodeCube<Real, D>& sums = std::get<Buffers>(grid.sums)[t];
  NodeCube<Real, D>& impulses = apart ? std::get<Buffers>(grid.impulses)[t] : sums;
  NodeCube<Real, D> v, v_start;
  if (pass.gather) read_blocks<Real, D>(tile, grid.v, v);
  if (pass.gather && flip) read_blocks<Real, D>(tile, grid.v_start, v_start);
  sums.fill(NodeOf<Real>{}), impulses.fill(NodeOf<Real>{});
  const HeldCells<D>* held = pass.stress ? state.holding.of(static_cast<int>(t)) : nullptr;
  const bool cells = pass.stress && settings.cell_pressure;
  const StencilFrame<Real, D> frame(grid.axes, state.shape, tile.at);
  PressureCells<Real, Geometry> before(grid.axes, tile.at, frame, settings.stress, held, cells),
      after(grid.axes, tile.at, frame, settings.stress, held, cells && pass.move);
  PassSums reduced;
  const auto first = static_cast<std::size_t>(tile.first_group),
             last = static_cast<std::size_t>(tile.last_group);
  std::vector<GroupCells> cell(cells || held ? last - first : 0);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    cell[i] = cells_of_group(frame, state.points, first + i);
    if (cells && pass.gather) before.enter(state.points, first + i, cell[i]);
  }
  if (cells && pass.gather) before.read(v);
  TilePass<Real, Geometry> in{mix,
                              law,
                              settings,
                              input,
                              tile,
                              grid.axes,
                              frame,
                              state.points,
                              v,
                              v_start,
                              sums,
                              impulses,
                              held,
                              cells,
                              cell.empty() ? nullptr : cell.data(),
                              before,
                              pass.move ? after : before,
                              reduced};
  for (std::size_t g = first; g < last; ++g) visit_group<pass>(in, g);
  if (cells) in.pressed.scatter_impulses(impulses);
  return reduced;
}

/// A pass over the points of all tiles, with the velocities that the nodes have. Tiles hold unequal numbers of points:
/// threads take them as they come, and add to sums that only they have.
template <Pass pass, class Real, class Geometry>
PassSums pass_over_points(const Mix& mix, const YieldLaw& law, const ExplicitSettings& settings,
                          const PassInput& input, ExplicitState<Geometry>& state) {
  std::vector<PassSums> of_tile(state.grid.tiles.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t t = 0; t < of_tile.size(); ++t)
    of_tile[t] = pass_over_tile<pass, Real, Geometry>(mix, law, settings, input, t, state);
  PassSums all;
  for (const PassSums& tile : of_tile) all.add(tile);
  return all;
}

}  // namespace tremie::detail
