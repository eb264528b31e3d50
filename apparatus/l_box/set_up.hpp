#pragma once

// The box on its grid: the filled column, the walls and bars inside the grid.
//
// Coordinates: x from the back of the column, up from the floor; the gate stands at x = column_length. In
// space y runs across the channel, from its middle plane in "half", from a side wall in "full".

#include <algorithm>
#include <cmath>
#include <vector>

#include "apparatus/l_box/l_box.hpp"
#include "apparatus/parts/bars.hpp"
#include "apparatus/run/body_readings.hpp"
#include "apparatus/run/step_settings.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie::l_box {

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
  Vec<D> high;
  high[0] = box.column_length, high[up] = box.column_height;
  body.grid.axes[0] =
      between_walls(box.column_length + box.channel_length, across, FaceKind::no_slip, FaceKind::no_slip);
  body.grid.axes[up] = {.h = h_up, .low = FaceKind::no_slip};
  if constexpr (D == 3) {
    const FaceKind side = scene.side_walls_slip ? FaceKind::free_slip : FaceKind::no_slip;
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
  const double step = gap_between_bars(scene) + bar_diameter;
  for (int i = 0; i < scene.bars; ++i)
    bars.push_back({scene.box.column_length + 0.5 * bar_diameter,
                    middle_plane(scene) + step * (i - 0.5 * (scene.bars - 1)), bar_diameter,
                    scene.box.channel_height});
  return bars;
}

inline bool resolves_bars(double cell) { return parts::resolves_bars(cell, bar_diameter); }

/// The column's front wall above the channel, to which the concrete sticks, and what is left of the gate
/// below it, along which it slips, half a cell between points; and the bars.
template <class Geometry>
std::vector<BoundaryPoint<Geometry::dim>> walls_inside(const Scene& scene,
                                                       const std::array<Axis, Geometry::dim>& axes,
                                                       double time) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  const Box& box = scene.box;
  const double spacing = 0.5 * axes[up].h;
  const double gate = scene.gate_speed ? *scene.gate_speed * time : box.channel_height;
  const int n = static_cast<int>(std::ceil(box.column_height / spacing));
  const int n_across = D == 3 ? 2 * axes[1].n_cells : 1;
  std::vector<BoundaryPoint<D>> points;
  for (int i = 0; i < n; ++i) {
    const double y = (i + 0.5) * spacing;
    const bool wall = y > box.channel_height;
    if (!wall && y < gate) continue;
    for (int k = 0; k < n_across; ++k) {
      BoundaryPoint<D> point;
      point.x[0] = box.column_length, point.x[up] = y;
      if constexpr (D == 3) point.x[1] = 0.5 * (k + 0.5) * axes[1].h;
      if (!wall) point.normal[0] = 1.0;
      points.push_back(point);
    }
  }
  if constexpr (D == 3)
    if (resolves_bars(axes[1].h))
      parts::add_resolved_bars(bars_of(scene), 0.5 * std::min(axes[1].h, axes[up].h), points);
  return points;
}

/// The runs in the box's two geometries, compiled apart.
Outcome run_plane(const Scene& scene, const scene::Observer& observer);
Outcome run_3d(const Scene& scene, const scene::Observer& observer);

}  // namespace tremie::l_box
