#pragma once

// Shape functions of eight points at once, and the sums over a point's 3^D nodes.

#include "libmpm/grid/tiles.hpp"
#include "libmpm/parallel/simd.hpp"

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
  /// Node that lies on a low wall.
  int low_wall() const { return kind == ShapeFunctions::gimp ? 1 : 0; }
  /// Place of a node [m].
  double node_position(const Axis& axis, int node) const {
    if (kind == ShapeFunctions::gimp) return axis.origin + (node - 1) * axis.h;
    return axis.node_position(node);
  }
};

/// Values, slopes [1/m] and arms times values [m] of eight points' three nodes in each direction, and
/// where their stencils begin in the tile's cube.
template <int D>
struct Weights {
  std::array<std::array<f64x8, 3>, D> w, dw, wa;
  std::array<f64x8, D> inertia;  ///< sum of w times arm squared [m^2]
  std::array<int, f64x8_size> base;
  bool together = false;  ///< all stencils begin at the same place
};

/// Cells of a tile in each direction that a point may have its pressure in.
inline constexpr int tile_pressure_cells = tile_cells + 3;

/// What a tile's weights need of one axis; cells and corners are counted from the tile's first.
template <class Real>
struct StencilAxisOf {
  Real h, ih, origin, first;                 ///< for place_in_tile
  Real half, inverse;                        ///< GIMP: of a point's extent, and 1/(2 half)
  bool walls;                                ///< whether one of these is in sight:
  Real low = Real(1e30), high = Real(1e30);  ///< cell (GIMP: corner) at a low and at a high wall
};
/// Places in cells, from a tile's first on: a point on a wall is at a whole number, to the bit.
inline f64x8 place_in_tile(double origin, double per_cell, double first, const f64x8& x) {
  return (x - origin) * per_cell - first;
}
using StencilAxis = StencilAxisOf<double>;
using SingleStencilAxis = StencilAxisOf<float>;

inline SingleStencilAxis in_single(const StencilAxis& a) {
  const auto f = [](double x) { return static_cast<float>(x); };
  return {f(a.h), f(a.ih), f(a.origin), f(a.first), f(a.half), f(a.inverse), a.walls, f(a.low), f(a.high)};
}

template <int D>
struct StencilFrame {
  ShapeFunctions kind;
  std::array<StencilAxis, D> axis;
  std::array<SingleStencilAxis, D> single;  ///< the same
};

template <int D>
StencilFrame<D> stencil_frame(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile) {
  StencilFrame<D> frame{.kind = shape.kind, .axis = {}, .single = {}};
  for (int d = 0; d < D; ++d) {
    const Axis& a = axes[d];
    StencilAxis& to = frame.axis[d];
    const double first = tile[d] * tile_cells;
    to.h = a.h, to.ih = 1.0 / a.h, to.origin = a.origin, to.first = first;
    to.half = shape.half[d], to.inverse = 0.5 / shape.half[d];
    if (a.wall_low()) to.low = -first;
    if (a.wall_high()) to.high = a.n_cells - (shape.kind == ShapeFunctions::gimp ? 0 : 1) - first;
    const auto seen = [](double at) { return at >= -1.0 && at <= tile_cells; };
    to.walls = seen(to.low) || seen(to.high);
    frame.single[d] = in_single(to);
  }
  return frame;
}

namespace detail {

/// s: place in the cell.
template <class Real, class Lanes>
[[gnu::always_inline]] inline void b_spline_weights(const StencilAxisOf<Real>& axis, const Lanes& cell,
                                                    const Lanes& s, Lanes (&w)[3], Lanes (&dw)[3],
                                                    Lanes (&arm)[3]) {
  const Lanes t = 1.0 - s;
  Lanes a = 0.5 - Lanes{}, b = a;
  if (axis.walls) a = cell == axis.low ? a + a : a, b = cell == axis.high ? b + b : b;
  const Lanes at = a * t, bs = b * s;
  w[0] = at * t, dw[0] = (-2 * axis.ih) * at;
  w[2] = bs * s, dw[2] = (2 * axis.ih) * bs;
  w[1] = 1.0 - w[0] - w[2], dw[1] = -dw[0] - dw[2];
  arm[0] = axis.h * (a - 1.0 - s), arm[1] = axis.h * (0.5 - s), arm[2] = axis.h * (2.0 - b - s);
}

/// u: distance from the nearest corner, in cells. A point whose extent would reach beyond a wall is taken
/// without extent: linear hats, whose node on the wall sets the velocity of the whole wall.
template <class Real, class Lanes>
[[gnu::always_inline]] inline void gimp_weights(const StencilAxisOf<Real>& axis, const Lanes& corner,
                                                const Lanes& u, Lanes (&w)[3], Lanes (&dw)[3],
                                                Lanes (&arm)[3]) {
  constexpr Real none = static_cast<Real>(1e-16), one_over_none = static_cast<Real>(0.5e16);
  Lanes half = axis.half - Lanes{}, inverse = axis.inverse - Lanes{};
  if (axis.walls) {
    const auto wall = (corner == axis.low) | (corner == axis.high);
    half = wall ? none - Lanes{} : half, inverse = wall ? one_over_none - Lanes{} : inverse;
  }
  // How much of the extent lies below and above the corner, and how far from it the rest is.
  const Lanes reached = min(max(u, -half), half), below = half - reached, above = half + reached, zero = {};
  const Lanes share_0 = below * inverse, share_2 = above * inverse;
  dw[0] = -axis.ih * share_0, dw[2] = axis.ih * share_2;
  w[0] = 0.5 * below * share_0 + max(reached - u, zero);
  w[2] = 0.5 * above * share_2 + max(u - reached, zero);
  w[1] = 1.0 - w[0] - w[2], dw[1] = -dw[0] - dw[2];
  arm[1] = -axis.h * u, arm[0] = arm[1] - axis.h, arm[2] = arm[1] + axis.h;
}

}  // namespace detail

/// Cells of eight points at x, numbered within the frame's tile. Real: in which their stencils are found; a
/// point whose place is rounded up into the next cell there must be in the same cell here.
template <int D, class Real>
void find_pressure_cells(const StencilFrame<D>& frame, const std::array<f64x8, D>& x,
                         std::array<int, f64x8_size>& cells) {
  f64x8 cell = {};
  const bool gimp = frame.kind == ShapeFunctions::gimp;
  const f64x8 low = all_lanes(gimp ? -2.0 : -1.0), high = all_lanes(tile_cells);
  for (int d = 0; d < D; ++d) {
    const StencilAxis& axis = frame.axis[d];
    f64x8 X = place_in_tile(axis.origin, axis.ih, axis.first, x[d]);
    if (std::is_same_v<Real, float> && !gimp) X = to_double(to_single(X, X), 0);
    cell = cell * tile_pressure_cells + (min(max(floor(X), low), high) + 2.0);
  }
  to_whole(cell, cells);
}

/// What is summed up beside the value.
struct Wanted {
  bool slopes = true, moments = true;
};
inline constexpr Wanted slopes_and_moments{}, slopes_only{.moments = false},
    value_only{.slopes = false, .moments = false};

/// Weights of eight points at x in a tile, as far as they are wanted. Points more than a cell outside of it
/// are taken at its rim: the caller makes sure that there are none.
template <int D, Wanted wanted = slopes_and_moments>
void weigh(const StencilFrame<D>& frame, const std::array<f64x8, D>& x, Weights<D>& weights) {
  f64x8 base = {};
  const f64x8 low = all_lanes(-1.0), high = all_lanes(tile_cells);
#pragma GCC unroll 3
  for (int d = 0; d < D; ++d) {
    const StencilAxis& axis = frame.axis[d];
    const f64x8 X = place_in_tile(axis.origin, axis.ih, axis.first, x[d]);
    f64x8 w[3], dw[3], arm[3], at;
    if (frame.kind == ShapeFunctions::gimp) {
      at = min(max(nearest(X), low), high);
      detail::gimp_weights(axis, at, X - at, w, dw, arm);
    } else {
      at = min(max(floor(X), low), high);
      detail::b_spline_weights(axis, at, X - at, w, dw, arm);
    }
    base = base * tile_span + (at + 1.0);
    weights.inertia[d] = f64x8{};
    for (int k = 0; k < 3; ++k) {
      weights.w[d][k] = w[k];
      if (wanted.slopes) weights.dw[d][k] = dw[k];
      if (!wanted.moments) continue;
      weights.wa[d][k] = w[k] * arm[k];
      weights.inertia[d] += weights.wa[d][k] * arm[k];
    }
  }
  weights.together = !any(i64x8(base != all_lanes(base[0])));
  to_whole(base, weights.base);
}
template <int D>
void weigh(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile,
           const std::array<f64x8, D>& x, Weights<D>& weights) {
  weigh<D>(stencil_frame<D>(axes, shape, tile), x, weights);
}

/// Weights of one point: what the sums below take. n: nodes a direction.
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

/// A nodal field at a point: its value and, as wanted, its slopes and first moments, each direction factored
/// out in turn.
template <int R, Wanted wanted>
struct Gathered {
  f64x4 value = {};
  f64x4 slope[wanted.slopes && R > 0 ? R : 1] = {};
  f64x4 moment[wanted.moments && R > 0 ? R : 1] = {};
};

template <int D, int n, Wanted wanted, int d = 0, class Node>
[[gnu::always_inline]] inline Gathered<D - d, wanted> gather(const Node* node, const PointWeights<D, n>& p) {
  Gathered<D - d, wanted> sum;
  if constexpr (d == D) {
    sum.value = in_double(*node);
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

/// Adds to every node value times w plus, for each direction e, slope[e] times the gradient's and
/// moment[e] times the arm's component e.
template <int D, int n, int d = 0, class Node>
[[gnu::always_inline]] inline void scatter(Node* node, const PointWeights<D, n>& p,
                                           const f64x4 (&along)[D][n], const f64x4& carried,
                                           const f64x4& weight) {
  for (int k = 0; k < n; ++k) {
    const f64x4 next = p.w[d][k] * carried + weight * along[d][k];
    Node* const at = node + k * stride<D>(tile_span, d);
    if constexpr (d == D - 1)
      add_to(*at, next);
    else
      scatter<D, n, d + 1>(at, p, along, next, p.w[d][k] * weight);
  }
}

template <int D, int n, class Node>
[[gnu::always_inline]] inline void scatter(Node* node, const PointWeights<D, n>& p, const f64x4& value,
                                           const f64x4 (&slope)[D], const f64x4 (&moment)[D]) {
  f64x4 along[D][n];
  for (int d = 0; d < D; ++d)
    for (int k = 0; k < n; ++k) along[d][k] = p.dw[d][k] * slope[d] + p.wa[d][k] * moment[d];
  scatter<D, n, 0>(node, p, along, value, f64x4{} + 1.0);
}

}  // namespace tremie
