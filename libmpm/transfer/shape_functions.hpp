#pragma once

// Shape functions of eight points at once, as the explicit steps have them.

#include "libmpm/grid/tiles.hpp"

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
};

/// What a tile's weights need of one axis; cells and corners are counted from the tile's first.
template <class Real>
struct StencilAxis {
  double origin, per_cell, first;            ///< for place()
  Real h, ih, half;                          ///< half: GIMP's, of a point's extent in cells
  bool walls;                                ///< whether one of these is in sight:
  Real low = Real(1e30), high = Real(1e30);  ///< cell (GIMP: corner) at a low and at a high wall

  /// Places in cells, from the tile's first on: a point on a wall is at a whole number, to the bit.
  SimdOf<Real> place(const f64x8& x) const { return to_real<Real>((x - origin) * per_cell - first); }
};

template <class Real, int D>
struct StencilFrame {
  ShapeFunctions kind;
  std::array<StencilAxis<Real>, D> axis;

  StencilFrame(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile)
      : kind(shape.kind) {
    for (int d = 0; d < D; ++d) {
      const Axis& a = axes[d];
      const double first = tile[d] * tile_cells;
      const auto real = [](double x) { return static_cast<Real>(x); };
      axis[d] = {a.origin, 1.0 / a.h, first, real(a.h), real(1.0 / a.h), real(shape.half[d]), false};
      if (a.wall_low()) axis[d].low = real(-first);
      if (a.wall_high()) axis[d].high = real(a.n_cells - (kind == ShapeFunctions::gimp ? 0 : 1) - first);
      const auto seen = [](Real at) { return at >= Real(-1) && at <= Real(tile_cells); };
      axis[d].walls = seen(axis[d].low) || seen(axis[d].high);
    }
  }
};

/// Values, slopes [1/m] and arms times values [m] of eight points' three nodes in each direction, and
/// where their stencils begin in the tile's cube.
template <class Real, int D>
struct Weights {
  SimdOf<Real> w[D][3], dw[D][3], wa[D][3];
  SimdOf<Real> inertia[D];  ///< sum of w times arm squared [m^2]
  std::array<int, f64x8_size> base;
  bool middle_counts;  ///< the middle node has a quarter of the weight or more in each direction
};

namespace detail {

/// One direction's weights w, their slopes dw and arms, in cells.
template <class V>
struct AxisWeights {
  V w[3], dw[3], arm[3];
};

/// s: place in the cell.
template <class Real, class V>
[[gnu::always_inline]] inline AxisWeights<V> b_spline_weights(const StencilAxis<Real>& axis, const V& cell,
                                                              const V& s) {
  const V t = 1 - s;
  V a = Real(0.5) - V{}, b = a;
  if (axis.walls) a = select(cell == axis.low, a + a, a), b = select(cell == axis.high, b + b, b);
  const V at = a * t, bs = b * s, w_0 = at * t, w_2 = bs * s, dw_0 = -2 * at, dw_2 = 2 * bs;
  return {{w_0, 1 - w_0 - w_2, w_2}, {dw_0, -dw_0 - dw_2, dw_2}, {a - 1 - s, Real(0.5) - s, 2 - b - s}};
}

/// u: distance from the nearest corner, in cells. A point whose extent would reach beyond a wall is taken
/// without extent: linear hats, whose node on the wall sets the velocity of the whole wall.
template <class Real, class V>
[[gnu::always_inline]] inline AxisWeights<V> gimp_weights(const StencilAxis<Real>& axis, const V& corner,
                                                          const V& u) {
  constexpr Real none = static_cast<Real>(1e-16);
  V half = axis.half - V{}, inverse = Real(0.5) / axis.half - V{};
  if (axis.walls) {
    const auto wall = (corner == axis.low) | (corner == axis.high);
    half = select(wall, none - V{}, half), inverse = select(wall, Real(0.5) / none - V{}, inverse);
  }
  // How much of the extent lies below and above the corner, and how far from it the rest is.
  const V reached = min(max(u, -half), half), below = half - reached, above = half + reached, zero = {};
  const V dw_0 = -below * inverse, dw_2 = above * inverse;
  const V w_0 = max(reached - u, zero) - Real(0.5) * below * dw_0,
          w_2 = max(u - reached, zero) + Real(0.5) * above * dw_2;
  return {{w_0, 1 - w_0 - w_2, w_2}, {dw_0, -dw_0 - dw_2, dw_2}, {-1 - u, -u, 1 - u}};
}

}  // namespace detail

/// Weights of eight points at x in a tile, with slopes and with arms if they are wanted. Points more than a cell outside of it are taken at its rim: the
/// caller makes sure that there are none.
template <class Real, int D, bool slopes = true, bool arms = true>
void weigh(const StencilFrame<Real, D>& frame, const std::array<f64x8, D>& x, Weights<Real, D>& weights) {
  using V = SimdOf<Real>;
  const V low = -1 - V{}, high = tile_cells - V{};
  V base = {};
  weights.middle_counts = true;
#pragma GCC unroll 3
  for (int d = 0; d < D; ++d) {
    const StencilAxis<Real>& axis = frame.axis[d];
    const bool gimp = frame.kind == ShapeFunctions::gimp;
    const V X = axis.place(x[d]), at = min(max(gimp ? nearest(X) : floor(X), low), high);
    const auto at_axis =
        gimp ? detail::gimp_weights(axis, at, X - at) : detail::b_spline_weights(axis, at, X - at);
    base = base * tile_span + (at + 1);
    if (!gimp && axis.walls) weights.middle_counts = false;
    weights.inertia[d] = V{};
    for (int k = 0; k < 3; ++k) {
      weights.w[d][k] = at_axis.w[k];
      if (slopes) weights.dw[d][k] = axis.ih * at_axis.dw[k];
      if (!arms) continue;
      const V arm = axis.h * at_axis.arm[k];
      weights.wa[d][k] = at_axis.w[k] * arm;
      weights.inertia[d] += weights.wa[d][k] * arm;
    }
  }
  weights.base = to_integers(base);
}

/// Cells of a tile in each direction that a point may have its pressure in.
inline constexpr int tile_pressure_cells = tile_cells + 3;

/// Cells of eight points at x, numbered within the frame's tile.
template <class Real, int D>
std::array<int, f64x8_size> find_pressure_cells(const StencilFrame<Real, D>& frame,
                                                const std::array<f64x8, D>& x) {
  using V = SimdOf<Real>;
  V cell = {};
  const V low = Real(frame.kind == ShapeFunctions::gimp ? -2 : -1) - V{}, high = tile_cells - V{};
  for (int d = 0; d < D; ++d)
    cell = cell * tile_pressure_cells + (min(max(floor(frame.axis[d].place(x[d])), low), high) + 2);
  return to_integers(cell);
}

}  // namespace tremie
