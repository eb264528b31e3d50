#pragma once

// Material points for the explicit steps: sorted by tile and cell, eight side by side, each quantity an array
// of its own.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "libmpm/grid/tiles.hpp"
#include "libmpm/law/lanes.hpp"
#include "libmpm/points/points.hpp"

namespace tremie {

/// What a material does not have is an empty array. The last group of a tile may be filled up with points
/// without mass, whose id is -1.
template <int D>
struct LanePoints {
  std::array<std::vector<Octet>, D> x, v;   ///< [m], [m/s]
  std::array<std::vector<Octet>, D * D> C;  ///< affine velocity, row by row [1/s]; empty with FLIP
  std::vector<Octet> mass, V0, ln_J;        ///< [kg], [m^3], ln(V/V0)
  std::vector<Octet> lambda, gamma_dot;     ///< empty without thixotropy
  std::vector<std::array<std::int32_t, octet_size>> id;  ///< place in the Points that it came from

  std::size_t groups() const { return mass.size(); }
  bool thixotropic() const { return !lambda.empty(); }
};

/// Number of real points in a group; they come first.
template <int D>
int filled(const LanePoints<D>& points, std::size_t group) {
  int n = 0;
  while (n < octet_size && points.id[group][static_cast<std::size_t>(n)] >= 0) ++n;
  return n;
}

namespace detail {

/// Visits every array of the points with the double that each point keeps there.
template <int D, class Visit>
void for_each_array(LanePoints<D>& lanes, bool affine, bool thixotropic, Visit visit) {
  for (int d = 0; d < D; ++d) {
    visit(lanes.x[d], [d](auto& p, std::size_t i) -> double& { return p.x[i][d]; });
    visit(lanes.v[d], [d](auto& p, std::size_t i) -> double& { return p.v[i][d]; });
  }
  for (int k = 0; k < D * D && affine; ++k)
    visit(lanes.C[k], [k](auto& p, std::size_t i) -> double& { return p.C[i](k / D, k % D); });
  visit(lanes.mass, [](auto& p, std::size_t i) -> double& { return p.mass[i]; });
  visit(lanes.V0, [](auto& p, std::size_t i) -> double& { return p.V0[i]; });
  visit(lanes.ln_J, [](auto& p, std::size_t i) -> double& { return p.ln_J[i]; });
  if (!thixotropic) return;
  visit(lanes.lambda, [](auto& p, std::size_t i) -> double& { return p.lambda[i]; });
  visit(lanes.gamma_dot, [](auto& p, std::size_t i) -> double& { return p.gamma_dot[i]; });
}

}  // namespace detail

/// Writes the state of the points back to where they came from.
template <int D>
void write_back(LanePoints<D>& lanes, const std::array<Axis, D>& axes, Points<D>& points) {
  const auto copy = [&](std::vector<Octet>& from, auto member) {
    for (std::size_t g = 0; g < lanes.groups(); ++g)
      for (int l = 0; l < octet_size; ++l) {
        const std::int32_t id = lanes.id[g][static_cast<std::size_t>(l)];
        if (id >= 0) member(points, static_cast<std::size_t>(id)) = from[g][l];
      }
  };
  detail::for_each_array<D>(lanes, !lanes.C[0].empty(), lanes.thixotropic(), copy);
  for (int d = 0; d < D; ++d) {
    const Axis& a = axes[d];
    if (!a.periodic) continue;
    for (auto& x : points.x) x[d] -= a.length() * std::floor((x[d] - a.origin) / a.length());
  }
}

/// Sorts the points by tile and cell into groups of eight; returns the tiles. `stencil_shift`: 0 where a
/// point's stencil begins with its cell, 1/2 where it is that of the nearest corner (GIMP).
template <int D>
std::vector<Tile<D>> sort_into_tiles(const std::array<Axis, D>& axes, double stencil_shift, bool affine,
                                     Points<D>& points, LanePoints<D>& lanes) {
  struct Key {
    Index<D> tile;
    std::int32_t cell, id;
    auto operator<=>(const Key&) const = default;
  };
  std::vector<Key> keys(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    Key& key = keys[p];
    key.cell = 0, key.id = static_cast<std::int32_t>(p);
    for (int d = 0; d < D; ++d) {
      const int c =
          static_cast<int>(std::floor((points.x[p][d] - axes[d].origin) / axes[d].h + stencil_shift));
      key.tile[d] = (c >= 0 ? c : c - tile_cells + 1) / tile_cells;
      key.cell = key.cell * tile_cells + (c - key.tile[d] * tile_cells);
      key.tile[d] = detail::wrapped(axes[d], key.tile[d]);
    }
  }
  std::sort(keys.begin(), keys.end());

  std::vector<Tile<D>> tiles;
  lanes.id.clear();
  int lane = octet_size;
  for (const Key& key : keys) {
    if (tiles.empty() || tiles.back().at != key.tile) {
      tiles.push_back({.at = key.tile, .first_group = static_cast<int>(lanes.id.size())});
      lane = octet_size;
    }
    if (lane == octet_size) {
      lanes.id.push_back({});
      lanes.id.back().fill(-1);
      lane = 0;
    }
    lanes.id.back()[static_cast<std::size_t>(lane++)] = key.id;
    tiles.back().last_group = static_cast<int>(lanes.id.size());
  }
  const auto copy = [&](std::vector<Octet>& to, auto member) {
    to.resize(lanes.id.size());
    for (std::size_t g = 0; g < lanes.id.size(); ++g)
      for (int l = 0; l < octet_size; ++l) {
        // What fills up a group stands where its first point does, so that its weights are finite.
        const std::int32_t id = lanes.id[g][static_cast<std::size_t>(l)];
        to[g][l] = member(points, static_cast<std::size_t>(id >= 0 ? id : lanes.id[g][0]));
        if (id < 0 && (&to == &lanes.mass || &to == &lanes.V0)) to[g][l] = 0.0;
      }
  };
  detail::for_each_array<D>(lanes, affine, points.thixotropic(), copy);
  return tiles;
}

}  // namespace tremie
