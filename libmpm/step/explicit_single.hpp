#pragma once

// The pass over the points with shape functions, sums, the law and stresses in single precision: sixteen
// points at once, two groups of eight. Places, ln J and flocculation stay in double precision.

#include "libmpm/step/explicit_pass.hpp"

namespace tremie::detail {

/// Two groups of eight side by side; the second is the first again, with no point of its own, at a tile's
/// end.
struct GroupPair {
  std::size_t g[2];
  int n[2];  ///< real points
  std::size_t real() const { return static_cast<std::size_t>(n[0] + n[1]); }
};

/// Updates the state of a pair, and gives its stress. The pressures are there twice: in the stress too where
/// they do not go by the cell.
template <Pass pass, class Space, class Law>
LaneStress<Space::dim, Singles> stress_of_pair(TilePass<pass, Space, Law, SingleNode>& in,
                                               const GroupPair& pair, const SingleFields<Space::dim>& read,
                                               const GroupCells (&cell)[2], Octet (&pressure)[2]) {
  constexpr int D = Space::dim;
  auto& points = in.points;
  const auto [a, b] = pair.g;
  const auto rate =
      strain_rate<Space, Singles>(read.along, read.value[0], to_single(points.x[0][a], points.x[0][b]));
  Octet gamma_dot[2], tau_y[2];
  for (int half = 0; half < 2; ++half) {
    gamma_dot[half] = to_double(rate.gamma_dot, half), tau_y[half] = pressure[half] = Octet{};
    if (pair.n[half] == 0) continue;
    const std::size_t g = pair.g[half];
    tau_y[half] = update_yield_stress<D>(in.mix, in.input.dt, gamma_dot[half], points, g, in.reduced);
    points.ln_J[g] += in.input.dt * divergence_of_group(in, to_double(rate.divergence, half), cell[half]);
  }
  const Singles volume =
      to_single(points.V0[a], points.V0[b]) * exp(to_single(points.ln_J[a], points.ln_J[b]));
  for (int half = 0; half < 2 && pair.n[half] > 0; ++half) {
    const Octet of_half = to_double(volume, half);
    in.reduced.volume += of_half, in.reduced.volume_rate += of_half * gamma_dot[half];
    pressure[half] = of_half * (-in.mix.K * points.ln_J[pair.g[half]]);
  }
  Singles held = volume;
  if (in.held) held *= look_up<sizeof(HeldCell<D>)>(&in.held->front().hold, cell[0], cell[1]);
  const Singles viscosity =
      held * viscosity_of(in.mix, in.law, rate.gamma_dot, to_single(tau_y[0], tau_y[1]));
  return stress_of<Space, Singles>(rate, viscosity,
                                   in.cells ? Singles{} : to_single(pressure[0], pressure[1]));
}

/// Moves a pair with what it read; the moments become its affine velocities.
template <Pass pass, class Space, class Law>
void move_pair(TilePass<pass, Space, Law, SingleNode>& in, const GroupPair& pair,
               const SingleWeights<Space::dim>& weights, SingleFields<Space::dim>& read) {
  constexpr int D = Space::dim;
  const auto& axes = in.state.grid.axes;
  const std::array<Singles, D> inverse = inverse_inertia<D>(axes, weights.inertia);
  for (int b = 0; b < D; ++b)
    for (int a = 0; a < D; ++a) read.along[b][a] *= inverse[b];
  for (int half = 0; half < 2 && pair.n[half] > 0; ++half) {
    const std::size_t g = pair.g[half];
    Octet v[D];
    for (int d = 0; d < D; ++d) in.points.v[d][g] = v[d] = to_double(read.value[d], half);
    move_places<D>(axes, in.input.dt, v, in.points, g, in.reduced);
    for (int b = 0; b < D && !in.points.C[0].empty(); ++b)
      for (int a = 0; a < D; ++a) in.points.C[a * D + b][g] = to_double(read.along[b][a], half);
  }
}

/// Velocities and affine velocities of a pair as they are kept.
template <int D>
SingleFields<D> kept_motion(const LanePoints<D>& points, const GroupPair& pair) {
  const std::size_t a = pair.g[0], b = pair.g[1];
  SingleFields<D> motion;
  for (int i = 0; i < D; ++i) {
    motion.value[i] = to_single(points.v[i][a], points.v[i][b]);
    for (int j = 0; j < D; ++j)
      motion.along[j][i] = to_single(points.C[i * D + j][a], points.C[i * D + j][b]);
  }
  return motion;
}

/// Momentum, mass and impulses of a pair to the controls.
template <Pass pass, class Space>
Reached scatter_pair(double impulse_dt, const SingleWeights<Space::dim>& weights,
                     const LaneStress<Space::dim, Singles>& stress, const SingleFields<Space::dim>& motion,
                     const GroupPair& pair, const LanePoints<Space::dim>& points, SingleNode* sums) {
  constexpr int D = Space::dim;
  constexpr bool hooped = pass.stress && std::is_same_v<Space, Axisymmetric>;
  constexpr Given given{.values = pass.move || hooped, .slopes = pass.stress, .moments = pass.move};
  const auto dt = static_cast<float>(impulse_dt);
  SingleSpread<D> spread;
  if (given.values)
    for (Singles& value : spread.value) value = Singles{};
  if (pass.move) {
    const Singles mass = spread.value[D] = to_single(points.mass[pair.g[0]], points.mass[pair.g[1]]);
    for (int i = 0; i < D; ++i) {
      spread.value[i] = mass * motion.value[i];
      for (int j = 0; j < D; ++j) {
        spread.moment[j][i] = mass * motion.along[j][i];
        spread.value[i] += spread.moment[j][i] * weights.middle[j];
      }
    }
  }
  for (int i = 0; i < D && pass.stress; ++i)
    for (int j = 0; j < D; ++j) spread.slope[j][i] = -dt * stress.sigma[i][j];
  if (hooped) spread.value[0] -= dt * stress.hoop / to_single(points.x[0][pair.g[0]], points.x[0][pair.g[1]]);
  return scatter_single<D, given>(weights, spread, pair.real(), sums);
}

template <Pass pass, class Space, class Law>
void visit_pair(TilePass<pass, Space, Law, SingleNode>& in, const GroupPair& pair) {
  constexpr int D = Space::dim;
  SingleWeights<D> weights;
  const auto place = [&] {
    constexpr Wanted wanted{.slopes = pass.stress, .moments = pass.move};
    weigh_single<D, wanted>(
        in.frame, {places_of<D>(in.points, pair.g[0]), places_of<D>(in.points, pair.g[1])}, weights);
  };
  place();
  LaneStress<D, Singles> stress;
  Octet pressure[2];
  GroupCells cell[2];
  SingleFields<D> read;
  if (pass.stress) {
    for (int half = 0; half < 2; ++half) cell[half] = cells_of_group(in, pair.g[half]);
    if (pass.gather)
      gather_slopes<D, std::is_same_v<Space, Axisymmetric>>(in.v.data(), weights, pair.real(), read);
    else
      read = {};
    stress = stress_of_pair(in, pair, read, cell, pressure);
  }
  if (pass.move && pass.gather) {
    gather_moments<D>(in.v.data(), weights, pair.real(), read);
    move_pair(in, pair, weights, read);
    place();
  } else if (pass.move) {
    read = kept_motion<D>(in.points, pair);
  }
  for (int half = 0; half < 2 && pair.n[half] > 0 && in.cells; ++half)
    push_cells(in, pair.g[half], pair.n[half], pressure[half], cell[half]);
  const Reached reached =
      scatter_pair<pass, Space>(in.input.impulse_dt, weights, stress, read, pair, in.points, in.sums.data());
  in.rows |= reached.rows;
  in.reduced.mixed += reached.runs;
}

/// All groups of a tile, two by two.
template <Pass pass, class Space, class Law>
void visit_groups(TilePass<pass, Space, Law, SingleNode>& in) {
  constexpr int D = Space::dim;
  const auto first = static_cast<std::size_t>(in.tile.first_group),
             last = static_cast<std::size_t>(in.tile.last_group);
  for (std::size_t g = first; g < last; g += 2) {
    GroupPair pair{{g, g}, {filled<D>(in.points, g), 0}};
    if (g + 1 < last) pair.g[1] = g + 1, pair.n[1] = filled<D>(in.points, g + 1);
    visit_pair(in, pair);
  }
}

}  // namespace tremie::detail
