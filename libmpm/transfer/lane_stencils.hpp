#pragma once

// Shape functions of eight points at once, and the sums over a point's 3^D controls.

#include "libmpm/grid/tiles.hpp"
#include "libmpm/law/lanes.hpp"

namespace tremie {

enum class ShapeFunctions {
  b_spline,  ///< quadratic B-splines with open ends at walls (grid/axis.hpp)
  gimp       ///< linear hats averaged over the point's own extent (Bardenhagen and Kober 2004)
};

/// What the explicit steps need to know of the shape functions.
template <int D>
struct Shape {
  ShapeFunctions kind = ShapeFunctions::b_spline;
  std::array<double, D> half{};  ///< GIMP: half of a point's extent, in cells; at most 1/2

  double stencil_shift() const { return kind == ShapeFunctions::gimp ? 0.5 : 0.0; }
  /// Control that lies on a low wall.
  int low_wall() const { return kind == ShapeFunctions::gimp ? 1 : 0; }
  /// Place of a control [m].
  double control_position(const Axis& axis, int control) const {
    if (kind == ShapeFunctions::gimp) return axis.origin + (control - 1) * axis.h;
    return axis.control_position(control);
  }
};

/// Values, slopes [1/m] and arms times values [m] of eight points' three controls in each direction, and
/// where their stencils begin in the tile's cube.
template <int D>
struct Weights {
  std::array<std::array<Octet, 3>, D> w, dw, wa;
  std::array<Octet, D> inertia;  ///< sum of w times arm squared [m^2]
  std::array<int, octet_size> base;
  bool together = false;  ///< all stencils begin at the same place
};

/// Cells of a tile in each direction that a point may have its pressure in.
inline constexpr int tile_pressure_cells = tile_cells + 3;

namespace detail {

inline void b_spline_weights(const Axis& axis, const Octet& cell_index, const Octet& s, Octet (&w)[3],
                             Octet (&dw)[3], Octet (&arm)[3]) {
  const Octet one = all_lanes(1.0), half = all_lanes(0.5), t = 1.0 - s;
  const OctetMask low = axis.wall_low() ? cell_index == 0.0 : one < 0.0;
  const OctetMask high = axis.wall_high() ? cell_index == double(axis.n_cells - 1) : one < 0.0;
  const Octet a = low ? one : half, b = high ? one : half;
  const double ih = 1.0 / axis.h;
  w[0] = a * t * t, dw[0] = (-2.0 * ih) * a * t;
  w[2] = b * s * s, dw[2] = (2.0 * ih) * b * s;
  w[1] = 1.0 - w[0] - w[2], dw[1] = -dw[0] - dw[2];
  arm[0] = axis.h * ((low ? one - 1.0 : -half) - s);
  arm[1] = axis.h * (0.5 - s);
  arm[2] = axis.h * ((high ? one : one + 0.5) - s);
}

/// u: distance from the nearest corner, in cells. A point whose extent would reach beyond a wall is taken
/// without extent: linear hats, whose control on the wall sets the velocity of the whole wall.
inline void gimp_weights(const Axis& axis, double extent, const Octet& corner_index, const Octet& u,
                         Octet (&w)[3], Octet (&dw)[3], Octet (&arm)[3]) {
  const Octet none = {}, point = all_lanes(1e-16);
  Octet half = all_lanes(extent), inverse = all_lanes(0.5 / extent);
  const auto shrink = [&](double corner) {
    const OctetMask wall = corner_index == corner;
    half = wall ? point : half, inverse = wall ? all_lanes(0.5e16) : inverse;
  };
  if (axis.wall_low()) shrink(0.0);
  if (axis.wall_high()) shrink(axis.n_cells);
  // How much of the extent lies below and above the corner, and how far the extent is from it.
  const Octet whole = half + half, below = min(max(half - u, none), whole),
              above = min(max(half + u, none), whole);
  const double ih = 1.0 / axis.h;
  dw[0] = -ih * (below * inverse), dw[2] = ih * (above * inverse);
  w[0] = 0.5 * below * (below * inverse) + max(-u - half, none);
  w[2] = 0.5 * above * (above * inverse) + max(u - half, none);
  w[1] = 1.0 - w[0] - w[2];
  dw[1] = -dw[0] - dw[2];
  for (int k = 0; k < 3; ++k) arm[k] = axis.h * ((k - 1) - u);
}

}  // namespace detail

/// Cells of eight points at x, numbered within a tile.
template <int D>
void find_pressure_cells(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile,
                         const std::array<Octet, D>& x, std::array<int, octet_size>& cells) {
  Octet cell = {};
  const Octet low = all_lanes(shape.kind == ShapeFunctions::gimp ? -2.0 : -1.0), high = all_lanes(tile_cells);
  for (int d = 0; d < D; ++d) {
    const Octet X = (x[d] - axes[d].origin) * (1.0 / axes[d].h) - tile[d] * tile_cells;
    cell = cell * tile_pressure_cells + (min(max(floor(X), low), high) + 2.0);
  }
  for (int l = 0; l < octet_size; ++l) cells[static_cast<std::size_t>(l)] = static_cast<int>(cell[l]);
}

/// Weights of eight points at x in a tile. Points more than a cell outside of it are taken at its rim: the
/// caller makes sure that there are none.
template <int D>
void weigh(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile,
           const std::array<Octet, D>& x, Weights<D>& weights) {
  Octet base = {};
  const Octet low = all_lanes(-1.0), high = all_lanes(tile_cells);
#pragma GCC unroll 3
  for (int d = 0; d < D; ++d) {
    const Axis& axis = axes[d];
    const double first = tile[d] * tile_cells;
    const Octet X = (x[d] - axis.origin) * (1.0 / axis.h) - first;
    Octet w[3], dw[3], arm[3], at;
    if (shape.kind == ShapeFunctions::gimp) {
      at = min(max(floor(X + 0.5), low), high);
      detail::gimp_weights(axis, shape.half[d], at + first, X - at, w, dw, arm);
    } else {
      at = min(max(floor(X), low), high);
      detail::b_spline_weights(axis, at + first, X - at, w, dw, arm);
    }
    base = base * tile_span + (at + 1.0);
    weights.inertia[d] = Octet{};
    for (int k = 0; k < 3; ++k) {
      weights.w[d][k] = w[k], weights.dw[d][k] = dw[k], weights.wa[d][k] = w[k] * arm[k];
      weights.inertia[d] += weights.wa[d][k] * arm[k];
    }
  }
  const OctetMask differs = base != all_lanes(base[0]);
  std::int64_t any = 0;
  for (int l = 0; l < octet_size; ++l) {
    weights.base[static_cast<std::size_t>(l)] = static_cast<int>(base[l]);
    any |= differs[l];
  }
  weights.together = any == 0;
}

/// Weights of one point: what the sums below take. n: controls a direction.
template <int D, int n>
struct PointWeights {
  static constexpr int n_controls = n;
  double w[D][n], dw[D][n], wa[D][n];
};

template <int D>
PointWeights<D, 3> of_lane(const Weights<D>& weights, int l) {
  PointWeights<D, 3> one;
  for (int d = 0; d < D; ++d)
    for (int k = 0; k < 3; ++k) {
      one.w[d][k] = weights.w[d][k][l];
      one.dw[d][k] = weights.dw[d][k][l];
      one.wa[d][k] = weights.wa[d][k][l];
    }
  return one;
}

/// What is summed up beside the value.
struct Wanted {
  bool slopes = true, moments = true;
};
inline constexpr Wanted slopes_and_moments{}, slopes_only{.moments = false}, moments_only{.slopes = false},
    value_only{.slopes = false, .moments = false};

/// A nodal field at a point: its value and, as wanted, its slopes and first moments, each direction factored
/// out in turn.
template <int R, Wanted wanted>
struct Gathered {
  NodeLanes value = {};
  NodeLanes slope[wanted.slopes && R > 0 ? R : 1] = {};
  NodeLanes moment[wanted.moments && R > 0 ? R : 1] = {};
};

template <int D, int n, Wanted wanted, int d = 0>
[[gnu::always_inline]] inline Gathered<D - d, wanted> gather(const NodeLanes* node,
                                                             const PointWeights<D, n>& p) {
  Gathered<D - d, wanted> sum;
  if constexpr (d == D) {
    sum.value = *node;
  } else {
    for (int k = 0; k < n; ++k) {
      const auto part = gather<D, n, wanted, d + 1>(node + k * stride<D>(tile_span, d), p);
      sum.value += p.w[d][k] * part.value;
      if constexpr (wanted.slopes) {
        sum.slope[0] += p.dw[d][k] * part.value;
        for (int e = 1; e < D - d; ++e) sum.slope[e] += p.w[d][k] * part.slope[e - 1];
      }
      if constexpr (wanted.moments) {
        sum.moment[0] += p.wa[d][k] * part.value;
        for (int e = 1; e < D - d; ++e) sum.moment[e] += p.w[d][k] * part.moment[e - 1];
      }
    }
  }
  return sum;
}

/// Adds to every control value times w plus, for each direction e, slope[e] times the gradient's and
/// moment[e] times the arm's component e.
template <int D, int n, int d = 0>
[[gnu::always_inline]] inline void scatter(NodeLanes* node, const PointWeights<D, n>& p,
                                           const NodeLanes (&along)[D][n], const NodeLanes& carried,
                                           const NodeLanes& weight) {
  for (int k = 0; k < n; ++k) {
    const NodeLanes next = p.w[d][k] * carried + weight * along[d][k];
    NodeLanes* const at = node + k * stride<D>(tile_span, d);
    if constexpr (d == D - 1)
      *at += next;
    else
      scatter<D, n, d + 1>(at, p, along, next, p.w[d][k] * weight);
  }
}

template <int D, int n>
[[gnu::always_inline]] inline void scatter(NodeLanes* node, const PointWeights<D, n>& p,
                                           const NodeLanes& value, const NodeLanes (&slope)[D],
                                           const NodeLanes (&moment)[D]) {
  NodeLanes along[D][n];
  for (int d = 0; d < D; ++d)
    for (int k = 0; k < n; ++k) along[d][k] = p.dw[d][k] * slope[d] + p.wa[d][k] * moment[d];
  scatter<D, n, 0>(node, p, along, value, NodeLanes{} + 1.0);
}

}  // namespace tremie
