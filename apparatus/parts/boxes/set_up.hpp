#pragma once

// The box on its grid: the filled column, the walls and bars inside the grid.
//
// Coordinates: x from the back of the column, up from the floor; the gate stands at x = column_length. In
// space y runs across the channel, from its middle plane in "half", from a side wall in "full".

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "apparatus/parts/bars.hpp"
#include "apparatus/parts/boxes/boxes.hpp"
#include "apparatus/run/body_readings.hpp"
#include "apparatus/run/step_settings.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie::boxes {

/// Width that is computed [m]; 1 in the plane, whose volumes are per metre.
inline double computed_width(const Scene& scene) {
  return scene.model.space == SpaceKind::half   ? 0.5 * scene.box.width
         : scene.model.space == SpaceKind::full ? scene.box.width
                                                : 1.0;
}

/// An axis between two walls, with cells of about `cell`.
inline Axis between_walls(double length, double cell, FaceKind low, FaceKind high) {
  const int n = std::max(1, static_cast<int>(std::lround(length / cell)));
  return {.h = length / n, .low = low, .high = high, .n_cells = n};
}

/// The axis along the channel, of cells of about `cell`, with a repeated knot at a face where the gate and the column's
/// front wall stand. Of the numbers of cells within a quarter of that the nearest is taken of which a face is within a
/// fiftieth of a cell from there, or else that with the nearest face.
inline Axis along_the_channel(const Box& box, double cell, FaceKind ends = FaceKind::no_slip) {
  const double length = box.column_length + box.channel_length, wanted = length / cell;
  const auto faces = [&](int n) { return std::max(1L, std::lround(n * box.column_length / length)); };
  const auto cost = [&](int n) {
    return std::max(0.02, std::abs(n * box.column_length / length - static_cast<double>(faces(n)))) +
           1e-3 * std::abs(n - wanted) / wanted;
  };
  int best = std::max(2, static_cast<int>(std::lround(wanted)));
  for (int n = std::max(2, static_cast<int>(wanted / 1.25)); n <= 1.25 * wanted + 1.0; ++n)
    if (cost(n) < cost(best)) best = n;
  return {.h = length / best,
          .low = ends,
          .high = ends,
          .n_cells = best,
          .repeated_knots = {static_cast<int>(faces(best))}};
}

/// Where the grid has the gate and the front wall [m].
inline double place_of_gate(const Axis& along) {
  return along.origin + along.repeated_knots.front() * along.h;
}

/// The flow stretches the concrete along the channel alone: there points_per_cell has its first number,
/// across the channel and up its second.
template <class Geometry>
Body<Geometry> filled_column(const Scene& scene) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  const Box& box = scene.box;
  Body<Geometry> body;
  body.mix = scene.mix;
  body.gravity[up] = -experiment::gravity;
  const auto [across, h_up] = scene.model.cell;
  const auto [n_along, n_up] = scene.model.points_per_cell;
  body.grid.axes[0] = along_the_channel(box, across, face(scene.walls));
  Vec<D> high;
  high[0] = place_of_gate(body.grid.axes[0]), high[up] = box.column_height;
  body.grid.axes[up] = {.h = h_up, .low = face(scene.walls)};
  if constexpr (D == 3) {
    const FaceKind side = scene.side_walls_slip ? FaceKind::free_slip : face(scene.walls);
    const bool half = scene.model.space == SpaceKind::half;
    high[1] = computed_width(scene);
    body.grid.axes[1] = between_walls(high[1], across, half ? FaceKind::symmetry : side, side);
  }
  std::array<int, D> n;
  for (int d = 0; d < D; ++d)
    n[d] =
        std::max(1, static_cast<int>(std::lround(high[d] / body.grid.axes[d].h * (d == 0 ? n_along : n_up))));
  seed_box<Geometry>(
      Vec<D>::Zero(), high, n, scene.mix.density, scene.mix.K, [](const Vec<D>&) { return true; },
      [&](const Vec<D>& x) { return scene.mix.density * experiment::gravity * (box.column_height - x[up]); },
      body.points);
  experiment::rest(body, scene.rest);
  return body;
}

/// Where the plane in the middle of the box is across the grid [m].
inline double middle_plane(const Scene& scene) {
  return scene.model.space == SpaceKind::half ? 0.0 : 0.5 * computed_width(scene);
}

/// The bars right in front of the gate: all gaps, those at the side walls included, are as wide.
inline std::vector<parts::Bar> bars_of(const Scene& scene) {
  std::vector<parts::Bar> bars;
  const double step = gap_between_bars(scene) + scene.box.bar_diameter;
  for (int i = 0; i < scene.bars; ++i)
    bars.push_back({scene.box.column_length + 0.5 * scene.box.bar_diameter,
                    middle_plane(scene) + step * (i - 0.5 * (scene.bars - 1)), scene.box.bar_diameter,
                    scene.box.channel_height});
  return bars;
}

/// The bars of a section, a metre of which is averaged over the box's width: a screen of a row of them.
inline std::vector<BarPoint<2>> screen_of_bars(const Scene& scene, double cell_up) {
  const double height = scene.box.channel_height;
  const int rows = static_cast<int>(std::ceil(2.0 * height / cell_up));
  BarPoint<2> bar{.x = {}, .axis = {0.0, 1.0}};
  bar.length = height / rows * scene.bars / scene.box.width, bar.diameter = scene.box.bar_diameter;
  bar.mobility = row_mobility(bar.diameter, gap_between_bars(scene) + bar.diameter);
  std::vector<BarPoint<2>> points;
  for (int k = 0; k < rows; ++k) {
    bar.x = {scene.box.column_length + 0.5 * bar.diameter, (k + 0.5) * height / rows};
    points.push_back(bar);
  }
  return points;
}

/// Puts the bars of the scene into a body.
template <class Geometry>
void add_bars(const Scene& scene, ImplicitBody<Geometry>& body) {
  if (scene.bars == 0) return;
  const auto& axes = body.grid.axes;
  if constexpr (Geometry::dim == 2)
    body.bars = screen_of_bars(scene, axes[1].h);
  else if (parts::resolves_bars(axes[1].h, scene.box.bar_diameter))
    parts::add_resolved_bars(bars_of(scene), 0.5 * std::min(axes[1].h, axes[2].h), body.boundary);
  else
    body.bars = parts::slender_bars(bars_of(scene), axes);
}

/// Height of the gate's lower edge [m].
inline double gate_edge(const Scene& scene, double time) {
  const double top = scene.box.channel_height;
  return scene.gate_speed ? std::min(top, *scene.gate_speed * time) : top;
}

/// The column's front wall above the channel, and what is left of the gate below it. Where the walls hold the concrete, it
/// slips along the gate all the same.
template <class Geometry>
std::vector<Sheet<Geometry::dim>> walls_inside(const Scene& scene, const Axis& along, double time) {
  const double edge = gate_edge(scene, time), top = scene.box.channel_height;
  Sheet<Geometry::dim> wall{.face = along.repeated_knots.front(), .along = Geometry::up};
  wall.from = top, wall.to = std::numeric_limits<double>::infinity(), wall.contact = face(scene.walls);
  std::vector<Sheet<Geometry::dim>> walls{wall};
  if (edge < top) {
    wall.from = edge, wall.to = top;
    if (wall.contact == FaceKind::no_slip) wall.contact = FaceKind::free_slip;
    wall.velocity[Geometry::up] = *scene.gate_speed;
    walls.push_back(wall);
  }
  return walls;
}

/// The runs in the box's two geometries, compiled apart.
Outcome run_plane(const Scene& scene, const scene::Observer& observer, ProgressText text);
Outcome run_3d(const Scene& scene, const scene::Observer& observer, ProgressText text);

}  // namespace tremie::boxes
