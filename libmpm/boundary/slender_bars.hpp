#pragma once

// Bars that the grid does not resolve: two or three in front of a gate, those of a cage.
//
// Points around the bar's surface, less than a cell apart, each take from the concrete their share of its drag. In a
// step that is a dissipation of the velocity u of the concrete past the bar at the point,
//
//   a_y tau_y D l |w| + mu l/(2 m) |w|^2,   w = u across the bar, a_x u along it,
//
// l the point's share of the bar's length and D the diameter. The yield part is solved exactly, as friction is.
//
// a_y = 4 sqrt 2 + 2 pi = 11.94 is the limit load of a rough cylinder (Randolph and Houlsby 1984). On cells as large
// as the bar it acts on the undisturbed flow: the grid carries more than that before it yields around the points by
// itself, so none of it is counted twice.
//
// The viscous part must leave out what the grid resolves. Points that hold the velocity at a ring of radius a = D/2 act
// as a cylinder that is thicker, for they hold their cells, and that is too slow by a mobility which grows with the
// logarithm of its radius. Between it and the bar lies m, which the walls and the other bars do not change, only the
// cells next to the bar: measured on rows of bars between planes of symmetry, whose drag is known in closed form
// (Tamada and Fujikawa 1957), in bar_mobility(). It vanishes on fine cells.
//
// The drag of a Bingham fluid is not linear between these two limits: the law is up to 10 % too large at a Bingham number
// tau_y D/(mu U) of 1, 21 % at 10, 3 % too small at 100 (tests/verification/bars.md).

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "libmpm/boundary/boundary_points.hpp"

namespace tremie {

/// Limit load of a rough cylinder across itself, per length, in tau_y D: 11.94.
inline constexpr double bar_yield_drag = 4.0 * std::numbers::sqrt2 + 2.0 * std::numbers::pi;

/// Drag along a bar over that across it: the shear on its surface, pi tau_y D, over its limit load.
inline constexpr double bar_drag_along = std::numbers::pi / bar_yield_drag;

/// Cells for which bar_mobility() was measured, in radii of the bar. On smaller ones boundary points resolve it.
inline constexpr double bar_cells_least = 1.0, bar_cells_most = 3.4;

/// A point on the surface of a bar and the piece that it stands for. In a step it is a wall term, w = scale u, with a yield
/// force a_y tau_y D l and the viscous drag mu l/m.
template <int D>
struct BarPoint {
  Vec<D> x;                          ///< [m]
  Vec<D> axis = Vec<D>::Zero();      ///< unit vector along the bar; zero in a section across it
  Vec<D> velocity = Vec<D>::Zero();  ///< of the bar [m/s]
  double length = 1.0;               ///< share of the bar's length [m]; a section is a metre deep
  double diameter = 0.0;             ///< [m]
  double mobility = 0.0;             ///< m: bar_mobility()
};

/// m of a bar on square cells of so many of its radii, which stands s0 and s1 of a cell away from a corner of the
/// cells: within 0.03/4 pi of what rows of bars gave, 3 % of their drag.
inline double bar_mobility(double cells, double s0, double s1) {
  const double mean = std::min(0.12 * cells, 0.19) + 0.11 * std::max(0.0, cells - 2.15);
  const double varies = 0.06 * std::max(0.0, cells - 1.7);
  const double round = 2.0 * std::numbers::pi;
  return (mean + varies * (std::cos(round * s0) + std::cos(round * s1))) / (4.0 * std::numbers::pi);
}

/// m of one of a row of bars that the grid smears into a screen, by the row's drag at the mean speed through it in a Newtonian
/// fluid: Tamada and Fujikawa (1957), from a spacing of three diameters on.
inline double row_mobility(double diameter, double spacing) {
  const double t = std::numbers::pi * diameter / spacing;
  return (1.0 - 2.0 * std::log(t) + t * t / 6.0) / (8.0 * std::numbers::pi);
}

namespace detail {

/// A ring of points around `centre`, in the plane of e and f, that stand for `length` of a bar along `axis`.
template <int D>
void add_ring(const Vec<D>& centre, const Vec<D>& e, const Vec<D>& f, const BarPoint<D>& bar, double cell,
              std::vector<BarPoint<D>>& points) {
  const double round = 2.0 * std::numbers::pi, a = 0.5 * bar.diameter;
  const int n = std::max(8, 2 * static_cast<int>(std::ceil(round * a / cell)));
  for (int k = 0; k < n; ++k) {
    const double angle = round * (k + 0.5) / n;
    BarPoint<D> point = bar;
    point.x = centre + a * (std::cos(angle) * e + std::sin(angle) * f);
    point.length = bar.length / n;
    points.push_back(point);
  }
}

}  // namespace detail

/// Points of a bar across a section, a metre of it.
inline void add_bar(const std::array<Axis, 2>& axes, const Vec<2>& at, double diameter,
                    std::vector<BarPoint<2>>& points) {
  const double cell = std::sqrt(axes[0].h * axes[1].h);
  BarPoint<2> bar;
  bar.diameter = diameter;
  const auto place = [&](int d) { return (at[d] - axes[d].origin) / axes[d].h; };
  bar.mobility = bar_mobility(2.0 * cell / diameter, place(0), place(1));
  detail::add_ring<2>(at, {1.0, 0.0}, {0.0, 1.0}, bar, cell, points);
}

/// Points of a bar along direction `along` of the grid, from `foot` over `length`, in rings half a cell apart.
inline void add_bar(const std::array<Axis, 3>& axes, const Vec<3>& foot, int along, double length,
                    double diameter, std::vector<BarPoint<3>>& points) {
  const int d0 = (along + 1) % 3, d1 = (along + 2) % 3;
  const double cell = std::sqrt(axes[d0].h * axes[d1].h);
  const int rings = std::max(1, static_cast<int>(std::ceil(2.0 * length / axes[along].h)));
  BarPoint<3> bar;
  bar.axis = Vec<3>::Unit(along);
  bar.diameter = diameter, bar.length = length / rings;
  const auto place = [&](int d) { return (foot[d] - axes[d].origin) / axes[d].h; };
  bar.mobility = bar_mobility(2.0 * cell / diameter, place(d0), place(d1));
  for (int i = 0; i < rings; ++i)
    detail::add_ring<3>(foot + (i + 0.5) * bar.length * bar.axis, Vec<3>::Unit(d0), Vec<3>::Unit(d1), bar,
                        cell, points);
}

/// Force of the concrete on a bar at a point [N].
template <int D>
Vec<D> bar_force(const PointTerm<D>& bar, const CellNodes<D>& cell_nodes, const std::vector<Vec<D>>& v) {
  return bar.scale * (bar.force + bar.viscous * slip_velocity(bar, cell_nodes, v));
}

}  // namespace tremie
