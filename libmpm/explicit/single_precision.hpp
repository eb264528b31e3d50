#pragma once

// The pass over the points with shape functions, sums, the law and stresses in single precision: sixteen
// points at once, two groups of eight. Places, ln J and flocculation stay in double precision.

#include <span>

#include "libmpm/explicit/pass.hpp"

namespace tremie::detail {

/// Two groups of eight side by side; the second is the first again, with no point of its own, at a tile's
/// end.
struct GroupPair {
  std::size_t g[2];
  int n[2];  ///< real points
  std::size_t real() const { return static_cast<std::size_t>(n[0] + n[1]); }
};

/// What a quantity is at the points of a pair.
inline f32x16 in_single(const std::vector<f64x8>& of, const GroupPair& pair) {
  return to_single(of[pair.g[0]], of[pair.g[1]]);
}

/// Updates the state of a pair, gives its pressures to their cells and its stress back. The stress has the
/// pressure where that does not go by the cell.
template <Pass pass, class Geometry, class Law>
LaneStress<Geometry::dim, f32x16> press_pair(TilePass<pass, Geometry, Law, f32x4>& in, const GroupPair& pair,
                                             const SingleFields<Geometry::dim>& read) {
  constexpr int D = Geometry::dim;
  auto& points = in.points;
  const GroupCells cell[2] = {cells_of_group(in, pair.g[0]), cells_of_group(in, pair.g[1])};
  const auto rate = strain_rate<Geometry, f32x16>(read.along, read.value[0], in_single(points.x[0], pair));
  f64x8 gamma_dot[2], tau_y[2], pressure[2];
  for (int half = 0; half < 2; ++half) {
    gamma_dot[half] = to_double(rate.gamma_dot, half), tau_y[half] = pressure[half] = f64x8{};
    if (pair.n[half] == 0) continue;
    const std::size_t g = pair.g[half];
    tau_y[half] = update_yield_stress<D>(in.mix, in.input.dt, gamma_dot[half], points, g, in.reduced);
    points.ln_J[g] += in.input.dt * divergence_of_group(in, to_double(rate.divergence, half), cell[half]);
  }
  const f32x16 volume = in_single(points.V0, pair) * exp(in_single(points.ln_J, pair));
  for (int half = 0; half < 2 && pair.n[half] > 0; ++half) {
    const f64x8 of_half = to_double(volume, half);
    in.reduced.volume += of_half, in.reduced.volume_rate += of_half * gamma_dot[half];
    pressure[half] = of_half * (-in.mix.K * points.ln_J[pair.g[half]]);
  }
  f32x16 held = volume;
  if (in.held) held *= look_up<sizeof(HeldCell<D>)>(&in.held->front().hold, cell[0], cell[1]);
  const f32x16 viscosity = held * viscosity_of(in.mix, in.law, rate.gamma_dot, to_single(tau_y[0], tau_y[1]));
  if (!in.cells) return stress_of<Geometry, f32x16>(rate, viscosity, to_single(pressure[0], pressure[1]));
  for (int half = 0; half < 2 && pair.n[half] > 0; ++half)
    in.pressed.push(cell[half], pair.n[half], in.input.impulse_dt * pressure[half]);
  return stress_of<Geometry, f32x16>(rate, viscosity, f32x16{});
}

/// Moves a pair with what it read; the moments become its affine velocities.
template <Pass pass, class Geometry, class Law>
void move_pair(TilePass<pass, Geometry, Law, f32x4>& in, const GroupPair& pair,
               const SingleWeights<Geometry::dim>& weights, SingleFields<Geometry::dim>& read) {
  constexpr int D = Geometry::dim;
  const std::array<f32x16, D> inverse = inverse_inertia<D>(in.frame, weights.inertia);
  for (int b = 0; b < D; ++b)
    for (int a = 0; a < D; ++a) read.along[b][a] *= inverse[b];
  for (int half = 0; half < 2 && pair.n[half] > 0; ++half) {
    const std::size_t g = pair.g[half];
    f64x8 v[D];
    for (int d = 0; d < D; ++d) in.points.v[d][g] = v[d] = to_double(read.value[d], half);
    move_places<D>(in.state.grid.axes, in.frame, in.input.dt, v, in.points, g, in.reduced);
    for (int b = 0; b < D && !in.points.C[0].empty(); ++b)
      for (int a = 0; a < D; ++a) in.points.C[a * D + b][g] = to_double(read.along[b][a], half);
  }
}

/// Velocities and affine velocities of a pair as they are kept.
template <int D>
SingleFields<D> kept_motion(const LanePoints<D>& points, const GroupPair& pair) {
  SingleFields<D> motion;
  for (int i = 0; i < D; ++i) {
    motion.value[i] = in_single(points.v[i], pair);
    for (int j = 0; j < D; ++j) motion.along[j][i] = in_single(points.C[i * D + j], pair);
  }
  return motion;
}

/// Mass and momentum of a pair to the nodes.
template <ShapeFunctions kind, int D>
Reached scatter_motion(const SingleWeights<D>& weights, const SingleFields<D>& motion, const GroupPair& pair,
                       const LanePoints<D>& points, f32x4* sums) {
  SingleMomenta<D> momenta;
  const f32x16 mass = momenta.value[D] = in_single(points.mass, pair);
  for (int i = 0; i < D; ++i) {
    momenta.value[i] = mass * motion.value[i];
    for (int j = 0; j < D; ++j) {
      momenta.moment[j][i] = mass * motion.along[j][i];
      momenta.value[i] += momenta.moment[j][i] * weights.middle[j];
    }
  }
  return scatter_momenta<kind, D>(weights, momenta, pair.real(), sums);
}

/// Impulses of a pair's stresses to the nodes; x_0: its first coordinates.
template <class Geometry>
Reached scatter_stress(double impulse_dt, const SingleWeights<Geometry::dim>& weights,
                       const LaneStress<Geometry::dim, f32x16>& stress, const GroupPair& pair,
                       const f32x16& x_0, f32x4* sums) {
  constexpr int D = Geometry::dim;
  constexpr bool hooped = std::is_same_v<Geometry, Axisymmetric>;
  const auto dt = static_cast<float>(impulse_dt);
  SingleImpulses<D> impulses;
  for (int i = 0; i < D; ++i) {
    for (int j = 0; j < D; ++j) impulses.slope[j][i] = -dt * stress.sigma[i][j];
    if constexpr (hooped) impulses.value[i] = i == 0 ? -dt * stress.hoop / x_0 : f32x16{};
  }
  return scatter_impulses<D, hooped>(weights, impulses, pair.real(), sums);
}

template <ShapeFunctions kind, WeighedFor use, int D>
void weigh_pair(const StencilFrame<D>& frame, const LanePoints<D>& points, const GroupPair& pair,
                SingleWeights<D>& weights) {
  weigh_single<kind, use, D>(frame, {places_of<D>(points, pair.g[0]), places_of<D>(points, pair.g[1])},
                             weights);
}

/// Pairs that go through a pass side by side, from part to part: what one of them waits for (a root, a
/// quotient, an exponential) the others fill.
inline constexpr std::size_t pairs_at_once = 2;
using Batch = std::span<const GroupPair>;

/// A pass with stress over a batch.
template <ShapeFunctions kind, Pass pass, class Geometry, class Law>
void press_batch(TilePass<pass, Geometry, Law, f32x4>& in, Batch batch) {
  constexpr int D = Geometry::dim;
  static_assert(pass.gather && !pass.move);
  SingleWeights<D> weights[pairs_at_once];
  SingleFields<D> read[pairs_at_once];
  LaneStress<D, f32x16> stress[pairs_at_once];
  for (std::size_t i = 0; i < batch.size(); ++i)
    weigh_pair<kind, WeighedFor::stress>(in.frame, in.points, batch[i], weights[i]);
  for (std::size_t i = 0; i < batch.size(); ++i)
    gather_slopes<D, std::is_same_v<Geometry, Axisymmetric>>(in.v.data(), weights[i], batch[i].real(),
                                                             read[i]);
  for (std::size_t i = 0; i < batch.size(); ++i) stress[i] = press_pair(in, batch[i], read[i]);
  for (std::size_t i = 0; i < batch.size(); ++i)
    in.count(scatter_stress<Geometry>(in.input.impulse_dt, weights[i], stress[i], batch[i],
                                      in_single(in.points.x[0], batch[i]), in.sums.data()));
}

/// A pass with motion over a batch.
template <ShapeFunctions kind, Pass pass, class Geometry, class Law>
void move_batch(TilePass<pass, Geometry, Law, f32x4>& in, Batch batch) {
  constexpr int D = Geometry::dim;
  static_assert(pass.move && !pass.stress);
  SingleWeights<D> weights[pairs_at_once];
  SingleFields<D> motion[pairs_at_once];
  if constexpr (pass.gather) {
    for (std::size_t i = 0; i < batch.size(); ++i)
      weigh_pair<kind, WeighedFor::reading>(in.frame, in.points, batch[i], weights[i]);
    for (std::size_t i = 0; i < batch.size(); ++i)
      gather_moments<kind, D>(in.v.data(), weights[i], batch[i].real(), motion[i]);
    for (std::size_t i = 0; i < batch.size(); ++i) move_pair(in, batch[i], weights[i], motion[i]);
  } else {
    for (std::size_t i = 0; i < batch.size(); ++i) motion[i] = kept_motion<D>(in.points, batch[i]);
  }
  for (std::size_t i = 0; i < batch.size(); ++i)
    weigh_pair<kind, WeighedFor::giving>(in.frame, in.points, batch[i], weights[i]);
  for (std::size_t i = 0; i < batch.size(); ++i)
    in.count(scatter_motion<kind, D>(weights[i], motion[i], batch[i], in.points, in.sums.data()));
}

/// All groups of a tile, two by two. With the stress first a pass has either stress or motion.
template <ShapeFunctions kind, Pass pass, class Geometry, class Law>
void visit_groups_as(TilePass<pass, Geometry, Law, f32x4>& in) {
  constexpr int D = Geometry::dim;
  const auto last = static_cast<std::size_t>(in.tile.last_group);
  for (auto g = static_cast<std::size_t>(in.tile.first_group); g < last;) {
    std::array<GroupPair, pairs_at_once> pairs;
    std::size_t n = 0;
    for (; n < pairs_at_once && g < last; ++n, g += 2) {
      pairs[n] = {{g, g}, {filled<D>(in.points, g), 0}};
      if (g + 1 < last) pairs[n].g[1] = g + 1, pairs[n].n[1] = filled<D>(in.points, g + 1);
    }
    if constexpr (pass.stress)
      press_batch<kind>(in, Batch(pairs.data(), n));
    else
      move_batch<kind>(in, Batch(pairs.data(), n));
  }
}
template <Pass pass, class Geometry, class Law>
void visit_groups(TilePass<pass, Geometry, Law, f32x4>& in) {
  if (in.frame.kind == ShapeFunctions::gimp)
    visit_groups_as<ShapeFunctions::gimp>(in);
  else
    visit_groups_as<ShapeFunctions::b_spline>(in);
}

}  // namespace tremie::detail
