#pragma once

// One direction of the background grid: cells of size h and quadratic B-splines, three per cell.
//
// Cell c covers [origin + c h, origin + (c+1) h] and sees the node values c, c+1, c+2. Node j sits at
// (j - 1/2) h from the origin (its Greville abscissa), except at a wall, where the knot vector is open: there
// the end spline is interpolatory, its node sits on the wall and fixing it fixes the velocity on the whole
// wall. A repeated knot is a face inside the grid with the same property: the velocity may bend there, and one
// node sits on it, one more than without. At a plane of symmetry the splines are those inside: the node
// behind the plane is the mirror image of the one before it.

#include <array>
#include <cmath>
#include <vector>

namespace tremie {

/// What a flat wall at the end of an axis does to the concrete.
enum class FaceKind {
  open,       ///< no wall: the grid goes on as far as there is concrete
  free_slip,  ///< normal velocity zero; also an axis
  symmetry,   ///< the other half of the body is behind it, mirrored; implicit steps alone
  wall_law,   ///< normal velocity zero, along it the step's wall law (boundary/wall_law.hpp)
  no_slip     ///< velocity zero
};

struct Axis {
  double h = 1.0;       ///< cell size [m]
  double origin = 0.0;  ///< position of the low face [m]
  FaceKind low = FaceKind::open;
  FaceKind high = FaceKind::open;
  bool periodic = false;
  int n_cells = 0;                       ///< of a periodic axis, or of one with a high wall; otherwise unused
  std::vector<int> repeated_knots = {};  ///< the cells above them, ascending; none at an end of the axis

  bool wall_low() const { return low != FaceKind::open; }
  bool wall_high() const { return high != FaceKind::open; }
  /// Whether the velocity is a wall's there: the end spline is interpolatory.
  bool clamped_low() const { return wall_low() && low != FaceKind::symmetry; }
  bool clamped_high() const { return wall_high() && high != FaceKind::symmetry; }
  double length() const { return h * n_cells; }

  int cell_of(double x) const {
    int c = static_cast<int>(std::floor((x - origin) / h));
    if (wall_low() && c < 0) c = 0;
    if (wall_high() && c >= n_cells) c = n_cells - 1;
    return c;
  }
  int n_repeated_knots() const { return static_cast<int>(repeated_knots.size()); }
  bool repeated(int face) const {
    for (int f : repeated_knots)
      if (f == face) return true;
    return false;
  }
  /// Whether a cell's first, last spline is interpolatory: a wall or a repeated knot is there.
  bool interpolates_low(int c) const { return (clamped_low() && c == 0) || repeated(c); }
  bool interpolates_high(int c) const { return (clamped_high() && c == n_cells - 1) || repeated(c + 1); }
  /// The first of the three nodes that a cell sees; that of the face below it, if that is a wall or a
  /// repeated knot.
  int first_node(int cell) const {
    int j = cell;
    for (int f : repeated_knots) j += f <= cell ? 1 : 0;
    return j;
  }
  /// Cell and node index as stored: wrapped on a periodic axis.
  int cell(int c) const { return periodic ? ((c % n_cells) + n_cells) % n_cells : c; }
  int node(int j) const {
    const int n = n_cells + n_repeated_knots();
    return periodic ? ((j % n) + n) % n : j;
  }
  bool on_low_wall(int j) const { return clamped_low() && j == 0; }
  bool on_high_wall(int j) const { return clamped_high() && j == n_cells + 1 + n_repeated_knots(); }
  /// The node that j, behind a plane of symmetry, is the mirror image of; j itself elsewhere.
  int mirrored(int j) const {
    if (low == FaceKind::symmetry && j == 0) return 1;
    if (high == FaceKind::symmetry && j == n_cells + 1 + n_repeated_knots()) return j - 1;
    return j;
  }
  double node_position(int j) const {
    if (on_low_wall(j)) return origin;
    if (on_high_wall(j)) return origin + length();
    int below = 0;
    for (int f : repeated_knots) {
      if (j == f + below + 1) return origin + f * h;
      below += j > f + below + 1 ? 1 : 0;
    }
    return origin + (j - below - 0.5) * h;
  }
};

/// Values and derivatives [1/m] of the three splines of a cell.
struct SplineValues {
  std::array<double, 3> N, dN;
};

/// Splines of cell c at the local coordinate s in [0, 1].
inline SplineValues splines(const Axis& axis, int c, double s) {
  const bool low = axis.interpolates_low(c), high = axis.interpolates_high(c);
  const double t = 1.0 - s, ih = 1.0 / axis.h;
  SplineValues v;
  v.N[0] = low ? t * t : 0.5 * t * t;
  v.dN[0] = (low ? -2.0 * t : -t) * ih;
  v.N[2] = high ? s * s : 0.5 * s * s;
  v.dN[2] = (high ? 2.0 * s : s) * ih;
  v.N[1] = 1.0 - v.N[0] - v.N[2];
  v.dN[1] = -v.dN[0] - v.dN[2];
  return v;
}

}  // namespace tremie
