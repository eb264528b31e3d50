#pragma once

// Material points for the explicit steps: sorted by tile and cell, eight side by side, each quantity an array
// of its own.

#include <algorithm>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "libmpm/grid/tiles.hpp"
#include "libmpm/parallel/buffers.hpp"
#include "libmpm/parallel/simd.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// What a material does not have is an empty array. A group may be filled up with points without mass, whose
/// id is -1.
template <int D>
struct LanePoints {
  std::array<std::vector<f64x8>, D> x, v;  ///< [m], [m/s]
  std::array<std::vector<f64x8>, D * D>
      C;                              ///< affine velocity, row by row [1/s]; empty where nobody reads it
  std::vector<f64x8> mass, V0, ln_J;  ///< [kg], [m^3], ln(V/V0)
  std::vector<f64x8> lambda;          ///< empty without thixotropy
  std::vector<f64x8> gamma_dot;       ///< [1/s]; empty where neither thixotropy nor a frame needs them
  std::vector<std::vector<f64x8>> lambda_parts;
  std::vector<std::array<std::int32_t, f64x8_size>> id;  ///< place in the Points that it came from
  std::size_t n = 0;                                     ///< number of real points

  std::size_t groups() const { return mass.size(); }
  bool thixotropic() const { return !lambda.empty(); }
};

template <int D>
std::array<f64x8, D> places_of(const LanePoints<D>& points, std::size_t group) {
  std::array<f64x8, D> x;
  for (int d = 0; d < D; ++d) x[d] = points.x[d][group];
  return x;
}

/// Number of real points in a group; they come first.
template <int D>
int filled(const LanePoints<D>& points, std::size_t group) {
  int n = f64x8_size;
  while (n > 0 && points.id[group][n - 1] < 0) --n;
  return n;
}

namespace detail {

/// The k-th double of what a point has of one quantity; matrices row by row.
inline double& entry(double& value, int) { return value; }
template <int D>
double& entry(Vec<D>& value, int k) {
  return value[k];
}
template <int D>
double& entry(Mat<D, D>& value, int k) {
  return value(k / D, k % D);
}

/// Visits the quantities that both kinds of points have, each with its arrays here and its array there.
template <int D, class Visit>
void for_each_quantity(LanePoints<D>& lanes, Points<D>& points, Visit visit) {
  const auto as_span = [](std::vector<f64x8>& array) { return std::span<std::vector<f64x8>>(&array, 1); };
  visit(std::span<std::vector<f64x8>>(lanes.x), points.x);
  visit(std::span<std::vector<f64x8>>(lanes.v), points.v);
  visit(std::span<std::vector<f64x8>>(lanes.C), points.C);
  visit(as_span(lanes.mass), points.mass);
  visit(as_span(lanes.V0), points.V0);
  visit(as_span(lanes.ln_J), points.ln_J);
  visit(as_span(lanes.lambda), points.lambda);
  visit(as_span(lanes.gamma_dot), points.gamma_dot);
  const std::size_t parts = std::max(lanes.lambda_parts.size(), points.lambda_parts.size());
  lanes.lambda_parts.resize(parts), points.lambda_parts.resize(parts);
  for (std::size_t k = 0; k < parts; ++k) visit(as_span(lanes.lambda_parts[k]), points.lambda_parts[k]);
}

}  // namespace detail

/// Writes the state of the points to where they came from; what is not kept of them stays empty there.
template <int D>
void write_back(LanePoints<D>& lanes, const std::array<Axis, D>& axes, Points<D>& points) {
  detail::for_each_quantity<D>(lanes, points, [&](std::span<std::vector<f64x8>> from, auto& to) {
    if (from.front().empty()) return;
    to.resize(lanes.n);
    for (std::size_t g = 0; g < lanes.groups(); ++g)
      for (int l = 0; l < f64x8_size; ++l) {
        const std::int32_t id = lanes.id[g][l];
        if (id < 0) break;  // the rest fills up the group
        for (std::size_t k = 0; k < from.size(); ++k)
          detail::entry(to[id], static_cast<int>(k)) = from[k][g][l];
      }
  });
  for (int d = 0; d < D; ++d) {
    const Axis& a = axes[d];
    if (!a.periodic) continue;
    for (auto& x : points.x) x[d] -= a.length() * std::floor((x[d] - a.origin) / a.length());
  }
}

/// Takes over the points, eight by eight as they come: to be sorted. One array after the other is given back:
/// there is no room for both in a large body. `rates`: keeps shear rates for a mix without thixotropy, too.
template <int D>
void take_points(Points<D>& points, bool affine, bool rates, LanePoints<D>& lanes) {
  const std::size_t n = points.size(), groups = (n + f64x8_size - 1) / f64x8_size;
  points.C.resize(affine ? n : 0, Mat<D, D>::Zero());  // none were brought back to points that start anew
  if (rates) points.gamma_dot.resize(n, 0.0);
  lanes.n = n;
  detail::for_each_quantity<D>(lanes, points, [&](std::span<std::vector<f64x8>> to, auto& from) {
    for (std::size_t k = 0; k < to.size() && !from.empty(); ++k) {
      to[k].reserve(groups + groups / 4);  // sorting fills groups up
      to[k].assign(groups, f64x8{});
      for (std::size_t p = 0; p < n; ++p)
        to[k][p / f64x8_size][p % f64x8_size] = detail::entry(from[p], static_cast<int>(k));
    }
    release(from);
  });
  lanes.id.assign(groups, {});
  for (std::size_t p = 0; p < groups * f64x8_size; ++p)
    lanes.id[p / f64x8_size][p % f64x8_size] = p < n ? static_cast<std::int32_t>(p) : -1;
}

namespace detail {

/// Where a point is sorted to (tiles in their order, and the cells of each) and where it was: eight times its group
/// plus its lane.
template <int D>
struct SortKey {
  Index<D> tile;
  std::int32_t cell, slot;
  auto operator<=>(const SortKey&) const = default;
};

/// Tile of a cell on an axis.
inline int tile_of(const Axis& axis, int cell) {
  return wrapped(axis, (cell >= 0 ? cell : cell - tile_cells + 1) / tile_cells);
}

/// Keys of all points in their order. The last direction of a tile's cells runs fastest.
template <int D>
std::vector<SortKey<D>> sort_keys(const std::array<Axis, D>& axes, double stencil_shift,
                                  const LanePoints<D>& lanes) {
  std::vector<SortKey<D>> keys;
  keys.reserve(lanes.n);
  for (std::size_t g = 0; g < lanes.groups(); ++g)
    for (std::size_t l = 0; l < f64x8_size && lanes.id[g][l] >= 0; ++l) {
      SortKey<D>& key = keys.emplace_back();
      key.slot = static_cast<std::int32_t>(g * f64x8_size + l);
      for (int d = 0; d < D; ++d) {
        const int c =
            static_cast<int>(std::floor((lanes.x[d][g][l] - axes[d].origin) / axes[d].h + stencil_shift));
        key.tile[d] = tile_of(axes[d], c);
        key.cell = key.cell * tile_cells + ((c % tile_cells) + tile_cells) % tile_cells;
      }
    }
  std::sort(keys.begin(), keys.end());
  return keys;
}

/// Slots that make up each group, -1 for what fills it up.
using GroupSlots = std::array<std::int32_t, f64x8_size>;

/// Brings what an array keeps of the points into the groups. What fills up a group stands where its first
/// point does, so that its weights are finite.
inline void permute(const std::vector<GroupSlots>& groups, bool zero_filled, std::vector<f64x8>& array) {
  if (array.empty()) return;
  std::vector<f64x8> sorted;
  sorted.reserve(array.capacity());
  sorted.resize(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t l = 0; l < f64x8_size; ++l) {
      const bool real = groups[g][l] >= 0;
      const auto slot = static_cast<std::size_t>(groups[g][real ? l : 0]);
      sorted[g][l] = real || !zero_filled ? array[slot / f64x8_size][slot % f64x8_size] : 0.0;
    }
  array.swap(sorted);
}

template <int D>
void permute_points(const std::vector<GroupSlots>& groups, LanePoints<D>& lanes) {
  std::vector<std::vector<f64x8>*> arrays;
  Points<D> none;
  for_each_quantity<D>(lanes, none, [&](std::span<std::vector<f64x8>> of_quantity, auto&) {
    for (std::vector<f64x8>& array : of_quantity) arrays.push_back(&array);
  });
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < arrays.size(); ++i)
    permute(groups, arrays[i] == &lanes.mass || arrays[i] == &lanes.V0, *arrays[i]);
  std::vector<std::array<std::int32_t, f64x8_size>> id(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t l = 0; l < f64x8_size; ++l) {
      const auto slot = static_cast<std::size_t>(std::max(groups[g][l], 0));
      id[g][l] = groups[g][l] < 0 ? -1 : lanes.id[slot / f64x8_size][slot % f64x8_size];
    }
  lanes.id = std::move(id);
}

/// Brings the points back into a periodic axis.
template <int D>
void wrap_points(const std::array<Axis, D>& axes, LanePoints<D>& lanes) {
  for (int d = 0; d < D; ++d)
    if (axes[d].periodic)
      for (f64x8& x : lanes.x[d]) x -= axes[d].length() * floor((x - axes[d].origin) / axes[d].length());
}

}  // namespace detail

/// Sorts the points by tile and cell into groups of eight, and gives their tiles; the last group of a tile is filled
/// up. `stencil_shift`: 0 where a point's stencil begins with its cell, 1/2 where it is that of the nearest
/// corner (GIMP).
template <int D>
std::vector<Tile<D>> sort_into_tiles(const std::array<Axis, D>& axes, double stencil_shift,
                                     LanePoints<D>& lanes) {
  detail::wrap_points<D>(axes, lanes);
  std::vector<Tile<D>> tiles;
  std::vector<detail::GroupSlots> groups;
  std::size_t filled = f64x8_size;  // of the last group
  for (const detail::SortKey<D>& key : detail::sort_keys<D>(axes, stencil_shift, lanes)) {
    const bool new_tile = tiles.empty() || tiles.back().at != key.tile;
    if (new_tile) tiles.push_back({.at = key.tile, .first_group = static_cast<int>(groups.size())});
    if (new_tile || filled == f64x8_size) groups.emplace_back().fill(-1), filled = 0;
    groups.back()[filled++] = key.slot;
    tiles.back().last_group = static_cast<int>(groups.size());
  }
  detail::permute_points<D>(groups, lanes);
  return tiles;
}

}  // namespace tremie
