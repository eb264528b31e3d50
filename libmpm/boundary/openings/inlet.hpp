#pragma once

// Concrete that enters a section through the mouth of a pipe in its middle.
//
// The pipe is a block of whole cells, from its mouth up; what flows in it is not computed. On the mouth the block prescribes the
// velocity of a plug that sticks to the pipe's wall: downwards and uniform but for the last cell, where the spline takes it to
// zero. As the plug comes down, rows of new points follow it. Volume that came in and is not half a row yet waits, column by
// column, so that what points hold and what waits is the flow times the time to rounding.

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/transfer/apic.hpp"

namespace tremie {

/// The mouth of a pipe about the axis x[0] = 0 of a section.
struct Inlet {
  /// A column of points below the mouth.
  struct Column {
    double x = 0.0;        ///< of its points [m]
    double area = 0.0;     ///< of the mouth that it covers [m^2; plane strain: m]
    double speed = 0.0;    ///< mean, at a flow of 1 [1/m^2]
    double waiting = 0.0;  ///< length that came in and holds no points yet [m]
  };
  int cells = 0, face = 0;  ///< across the pipe; the mouth: the cells above it are the pipe's
  double flow = 0.0;        ///< [m^3/s]
  double node_speed = 0.0;  ///< of the plug, at a flow of 1 [1/m^2]
  double row = 0.0;         ///< height of a row of points [m]
  std::vector<Column> columns = {};
};

/// The largest speed on the mouth [m/s].
inline double plug_speed(const Inlet& inlet) { return inlet.flow * inlet.node_speed; }

/// The mouth on a grid: `cells` across, at the face `face`, with `columns` of points that cover as much of it each, and rows of
/// height `row` [m]. A ring of points spreads as it moves outwards: equal widths would make small ones of those near the axis. The
/// disk at the axis is three rings, or a void would open there where the concrete fans out.
template <class Geometry>
Inlet make_inlet(const std::array<Axis, 2>& axes, int cells, int face, int columns, double row) {
  Inlet inlet{.cells = cells, .face = face, .row = row};
  constexpr int n = 64;  // midpoints between two columns
  constexpr double power = std::is_same_v<Geometry, Axisymmetric> ? 0.5 : 1.0;
  const double h = axes[0].h, edge = cells * h;
  double through = 0.0;  // at the speed 1 of the plug
  std::vector<double> faces{0.0};
  if (power < 1.0)
    for (const double part : {1.0 / 3.0, 2.0 / 3.0})
      faces.push_back(part * edge * std::pow(1.0 / columns, power));
  for (int j = 1; j <= columns; ++j)
    faces.push_back(edge * std::pow(static_cast<double>(j) / columns, power));
  for (std::size_t j = 0; j + 1 < faces.size(); ++j) {
    const double from = faces[j], to = faces[j + 1];
    Inlet::Column column;
    double flow = 0.0, moment = 0.0;
    for (int k = 0; k < n; ++k) {
      const double x = from + (k + 0.5) / n * (to - from), into_last = std::max(0.0, x / h - (cells - 1));
      const double area = (to - from) / n * Geometry::measure({x, 0.0}), v = 1.0 - into_last * into_last;
      column.area += area, flow += area * v, moment += area * v * x;
    }
    column.x = moment / flow, column.speed = flow / column.area;
    through += flow;
    inlet.columns.push_back(column);
  }
  for (Inlet::Column& column : inlet.columns) column.speed /= through;
  inlet.node_speed = 1.0 / through;
  return inlet;
}

/// Puts the pipe into the grid for the step to come: its block, whose mouth has the inlet's speed, and the knots that it needs.
/// What a body keeps by nodes must be forgotten where the mouth has moved.
inline void place_pipe(const Inlet& inlet, ActiveGrid<2>& grid) {
  constexpr int no_end = 1 << 24;
  grid.axes[0].repeated_knots = {inlet.cells};
  grid.axes[1].repeated_knots = {inlet.face};
  const double wall = (inlet.cells - 1e-6) * grid.axes[0].h,
               mouth = grid.axes[1].origin + (inlet.face + 1e-6) * grid.axes[1].h;
  grid.blocks = {
      {{0, inlet.face}, {inlet.cells, no_end}, [wall, mouth, speed = plug_speed(inlet)](const Vec<2>& x) {
         return Vec<2>(0.0, x[0] < wall && x[1] < mouth ? -speed : 0.0);
       }}};
}

/// What came in over dt: calls add(x, volume, speed) for every point of the rows that follow it. Up to half a row waits: a void
/// below the mouth would be filled from below by what evens the points out, and they would crowd there.
template <class Add>
void let_in(Inlet& inlet, const Axis& up, double dt, Add add) {
  const double mouth = up.origin + inlet.face * up.h;
  for (Inlet::Column& column : inlet.columns) {
    column.waiting += inlet.flow * column.speed * dt;
    const int rows = static_cast<int>(std::lround(column.waiting / inlet.row));
    if (rows < 1) continue;
    const double row = column.waiting / rows;
    for (int k = 0; k < rows; ++k)
      add(Vec<2>(column.x, mouth - (k + 0.5) * row), column.area * row, inlet.flow * column.speed);
    column.waiting = 0.0;
  }
}

/// Volume that came in and holds no points yet [m^3].
inline double volume_waiting(const Inlet& inlet) {
  double volume = 0.0;
  for (const Inlet::Column& column : inlet.columns) volume += column.area * column.waiting;
  return volume;
}

/// Bends the last step's straight moves of the points by what a steady flow's velocity changes along them, dt^2/2 grad v v: of
/// second order, like the volume of what moves. Straight moves of half a cell, step after step through the fan below a mouth,
/// crowd the points by several per cent.
inline void bend_paths(const ActiveGrid<2>& grid, double dt, Points<2>& points) {
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec<2> from = points.x[p];
    points.x[p] += 0.5 * dt * dt * points.C[p] * points.v[p];
    keep_in_domain<2>(grid, from, points.x[p]);
  }
}

/// Moves the mouth up by whole cells. The concrete that stood in the pipe there, and as much as the pipe's wall displaced,
/// stays: calls add(x, volume, 0) for every point of it.
template <class Add>
void pull_up(Inlet& inlet, const Axis& up, int cells, Add add) {
  const double from = up.origin + inlet.face * up.h, length = cells * up.h;
  const int rows = std::max(1, static_cast<int>(std::lround(length / inlet.row)));
  for (const Inlet::Column& column : inlet.columns)
    for (int k = 0; k < rows; ++k)
      add(Vec<2>(column.x, from + (k + 0.5) * length / rows), column.area * length / rows, 0.0);
  inlet.face += cells;
}

}  // namespace tremie
