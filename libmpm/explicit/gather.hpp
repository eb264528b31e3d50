#pragma once

// What one pass over the points of a tile is asked for, what it sums up, and how it reads the grid.

#include "libmpm/explicit/body.hpp"
#include "libmpm/transfer/simd_sums.hpp"

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

/// Reduced over the points of a tile, then over the tiles in their order.
struct PassSums {
  double farthest = 0.0;  ///< largest move along an axis, in cells
  double speed2 = 0.0;    ///< largest, squared [m^2/s^2]
  double volume = 0.0, volume_rate = 0.0, lambda = 0.0;
  bool ran_away = false;
  std::int64_t mixed = 0;  ///< groups of points of several cells; in single precision runs of one stencil

  void add(const PassSums& other) {
    farthest = std::max(farthest, other.farthest), speed2 = std::max(speed2, other.speed2);
    volume += other.volume, volume_rate += other.volume_rate;
    lambda = std::max(lambda, other.lambda), ran_away = ran_away || other.ran_away;
    mixed += other.mixed;
  }
};

/// The same for each lane, while a tile's groups are visited.
struct LaneSums {
  f64x8 farthest = {}, speed2 = {}, volume = {}, volume_rate = {}, lambda = {};
  i64x8 ran_away = {};
  std::int64_t mixed = 0;

  PassSums reduced() const {
    bool away = false;
    for (int l = 0; l < f64x8_size; ++l) away = away || ran_away[l] != 0;
    return {largest(farthest), largest(speed2), sum(volume), sum(volume_rate), largest(lambda), away, mixed};
  }
};

/// Grid fields at eight points, as far as a pass reads them.
template <int D>
struct Fields {
  f64x8 v[4], v_start[4], L[D][4], moment[D][4];  ///< L[b][a] = dv_a/dx_b
};

template <int D>
using Cube = typename TileGrid<D>::Buffer;

/// Eight points whose stencils begin at one node.
template <Wanted wanted, int D>
void gather_side_by_side(const f64x4* node, const Weights<D>& weights, Fields<D>& fields) {
  for (int c = 0; c < D; ++c) {
    const auto at = gather_together<D, wanted>(node, c, weights);
    fields.v[c] = at.value;
    for (int d = 0; d < D && wanted.slopes; ++d) fields.L[d][c] = at.slope[d];
    for (int d = 0; d < D && wanted.moments; ++d) fields.moment[d][c] = at.moment[d];
  }
}

/// n points one by one; what fills up the group is taken with the first.
template <Wanted wanted, int D>
void gather_one_by_one(const Cube<D>& v, const Weights<D>& weights, int n, Fields<D>& fields) {
  f64x4 value[f64x8_size], slope[D][f64x8_size], moment[D][f64x8_size];
  for (int l = 0; l < f64x8_size; ++l) {
    const int from = l < n ? l : 0;
    const auto at =
        gather<D, 3, wanted>(&v[weights.base[static_cast<std::size_t>(from)]], of_lane<D>(weights, from));
    value[l] = at.value;
    for (int d = 0; d < D && wanted.slopes; ++d) slope[d][l] = at.slope[d];
    for (int d = 0; d < D && wanted.moments; ++d) moment[d][l] = at.moment[d];
  }
  to_columns(value, fields.v);
  for (int d = 0; d < D && wanted.slopes; ++d) to_columns(slope[d], fields.L[d]);
  for (int d = 0; d < D && wanted.moments; ++d) to_columns(moment[d], fields.moment[d]);
}

/// Points of a few cells: side by side for each place that their stencils begin at, every point kept from its
/// own. False if there are too many such places: then nothing is read.
template <Wanted wanted, int D>
bool gather_by_place(const Cube<D>& v, const Weights<D>& weights, int n, Fields<D>& fields) {
  constexpr int most_places = 3;  // as dear as one by one
  std::array<int, most_places> place;
  int places = 0;
  i64x8 at = {};  // which of the places each point has
  for (int l = 0; l < n; ++l) {
    const int base = weights.base[static_cast<std::size_t>(l)];
    int k = 0;
    while (k < places && place[static_cast<std::size_t>(k)] != base) ++k;
    if (k == most_places) return false;
    if (k == places) place[static_cast<std::size_t>(places++)] = base;
    at[l] = k;
  }
  gather_side_by_side<wanted, D>(&v[place[0]], weights, fields);
  for (int k = 1; k < places; ++k) {
    Fields<D> here;
    gather_side_by_side<wanted, D>(&v[place[static_cast<std::size_t>(k)]], weights, here);
    const i64x8 take = at == k;
    for (int c = 0; c < D; ++c) {
      fields.v[c] = take ? here.v[c] : fields.v[c];
      for (int d = 0; d < D && wanted.slopes; ++d) fields.L[d][c] = take ? here.L[d][c] : fields.L[d][c];
      for (int d = 0; d < D && wanted.moments; ++d)
        fields.moment[d][c] = take ? here.moment[d][c] : fields.moment[d][c];
    }
  }
  return true;
}

template <Wanted wanted, int D>
void gather_group(const Cube<D>& v, const Weights<D>& weights, int n, Fields<D>& fields) {
  if (weights.together)
    gather_side_by_side<wanted, D>(&v[weights.base[0]], weights, fields);
  else if (!gather_by_place<wanted, D>(v, weights, n, fields))
    gather_one_by_one<wanted, D>(v, weights, n, fields);
}

/// Reads what a pass needs. FLIP needs no moments, and a pass without stress no slopes.
template <Pass pass, int D>
void gather_for(const Cube<D>& v, const Cube<D>& v_start, const Weights<D>& weights, int n, bool flip,
                Fields<D>& fields) {
  constexpr Wanted without{.slopes = pass.stress, .moments = false};
  constexpr Wanted with{.slopes = pass.stress, .moments = true};
  if (pass.move && !flip)
    gather_group<with, D>(v, weights, n, fields);
  else
    gather_group<without, D>(v, weights, n, fields);
  if (!pass.move || !flip) return;
  Fields<D> start;
  gather_group<value_only, D>(v_start, weights, n, start);
  for (int d = 0; d < D; ++d) fields.v_start[d] = start.v[d];
}

}  // namespace tremie::detail
