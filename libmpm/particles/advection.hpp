#pragma once

// How the points of a space move with the velocities of the grid.

#include "libmpm/geometry/polar.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// In a space whose coordinates are lengths along fixed directions.
struct StraightAhead {
  /// What changes of the coordinates x in a second where the velocity is v.
  template <int D>
  Vec<D> rate(const Vec<D>&, const Vec<D>& v) const {
    return v;
  }
  /// Point p over dt, with the velocity v that the grid has where it is.
  template <int D>
  void move(Points<D>& points, int p, const Vec<D>& v, double dt) const {
    points.x[p] += dt * v;
  }
  /// Point p by the displacement u [m].
  template <int D>
  void shift(Points<D>& points, int p, const Vec<D>& u) const {
    points.x[p] += u;
  }
};

template <class Geometry>
struct Motion : StraightAhead {};

/// In circles, by arcs: a point that turns about the axis keeps its radius, whatever the step. The grid may
/// turn too.
///
/// The basis turns with the point. Its angular momentum r v_theta stays what it is, and v_r takes up the
/// centrifugal acceleration: together Newton's law without a force.
template <>
struct Motion<Polar> {
  double grid_rate = 0.0;  ///< at which the axes turn [rad/s]

  Vec<2> rate(const Vec<2>& x, const Vec<2>& v) const { return {v[0], v[1] / x[0] - grid_rate}; }

  void move(Points<2>& points, int p, const Vec<2>& v, double dt) const {
    Vec<2>& x = points.x[p];
    // Second order: the velocity in the middle of the move, by the point's own affine field.
    const Vec<2> half = 0.5 * dt * rate(x, v);
    const double r = x[0], r_middle = std::max(0.5 * r, r + half[0]);
    const Vec<2> v_middle = v + points.C[p] * half;
    x[0] = std::max(0.5 * r, r + dt * v_middle[0]);
    x[1] += dt * (v_middle[1] / r_middle - grid_rate);
    Vec<2>& own = points.v[p];
    own[0] += dt * own[1] * own[1] / r_middle;
    own[1] *= r / x[0];
  }

  void shift(Points<2>& points, int p, const Vec<2>& u) const {
    Vec<2>& x = points.x[p];
    x[1] += u[1] / x[0];
    x[0] += u[0];
  }
};

}  // namespace tremie
