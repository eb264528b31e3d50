#pragma once

// What is read off the concrete: depths, front, profile.
//
// EN 12350-10 has H1 and H2 as the mean depth of the concrete behind the gate and at the channel's end. A
// depth is the volume of what stands on the floor over its area: up to the highest row of cells of which at
// least half is concrete, with the four above it, in which the surface and what lies loosely on it are (of 10 Pa
// on cells of 10 mm 0.4 of a row, then 0.1, 0.07, 0.04: 2 mm). What hangs on the walls or falls through the air
// higher up is no depth, and neither are the holes that points may leave. Where the concrete meets a wall it tells
// nothing: films hang down onto it in the column, and the cells at the end wall never fill up. So nothing
// within off_the_walls of a wall is read: H1 is the mean depth over the rest of the column's length, H2 that
// over as much before the channel's end.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apparatus/parts/boxes/set_up.hpp"

namespace tremie::boxes {

inline constexpr double off_the_walls = 0.02;  ///< no depth is read nearer to a wall [m]
inline constexpr std::size_t loose_rows = 4;   ///< above the highest row that is half full

/// Share of a point at `x` that lies in [low, high], where it reaches half of `size` to both sides [m].
inline double share_in(double x, double size, double low, double high) {
  const double inside = std::min(x + 0.5 * size, high) - std::max(x - 0.5 * size, low);
  return std::clamp(inside / size, 0.0, 1.0);
}

/// Mean depth over [low, high] along the channel [m], of a body `width` wide, in rows of height `row`, with points as
/// long as they were seeded, `size`.
template <class Geometry>
double depth(const Points<Geometry::dim>& points, double low, double high, double row, double width,
             double size) {
  std::vector<double> fill(2, 0.0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double share = share_in(points.x[p][0], size, low, high);
    if (share == 0.0) continue;
    const std::size_t j = static_cast<std::size_t>(std::max(0.0, points.x[p][Geometry::up]) / row);
    if (j + 2 > fill.size()) fill.resize(j + 2, 0.0);
    fill[j] += share * points.volume(p) / ((high - low) * width * row);
  }
  std::size_t top = fill.size();
  while (top > 0 && fill[top - 1] < 0.5) --top;
  const auto end = fill.begin() + static_cast<std::ptrdiff_t>(std::min(fill.size(), top + loose_rows));
  return row * std::accumulate(fill.begin(), end, 0.0);
}

/// The stretches over which H1 and H2 are read, in x [m].
struct Stretch {
  double low, high;
};
inline Stretch behind_the_gate(const Box& box) { return {off_the_walls, box.column_length - off_the_walls}; }
inline Stretch at_the_end(const Box& box) {
  const double end = box.column_length + box.channel_length - off_the_walls;
  return {end - (box.column_length - 2.0 * off_the_walls), end};
}

/// As points are seeded along the box [m].
template <class Geometry>
double point_length(const Body<Geometry>& body, const Scene& scene) {
  return body.grid.axes[0].h / scene.model.points_per_cell[0];
}

/// Share of the volume that a step took from the column into the channel, or back, more than a cell above the opening,
/// which reaches up to `edge`; `from`: where the points were.
template <class Geometry>
double share_through_the_wall(const Body<Geometry>& body, const std::vector<Vec<Geometry::dim>>& from,
                              double edge) {
  constexpr int up = Geometry::up;
  const double wall = place_of_gate(body.grid.axes[0]), above = edge + body.grid.axes[up].h;
  double through = 0.0, all = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const Vec<Geometry::dim>& to = body.points.x[p];
    all += body.points.volume(p);
    if ((from[p][0] < wall) != (to[0] < wall) && std::min(from[p][up], to[up]) > above)
      through += body.points.volume(p);
  }
  return through / all;
}

template <class Geometry>
Sample read(const Body<Geometry>& body, const Scene& scene, const StepReport& step) {
  const Box& box = scene.box;
  const double row = body.grid.axes[Geometry::up].h, width = computed_width(scene);
  const auto depth_over = [&](const Stretch& s) {
    return depth<Geometry>(body.points, s.low, s.high, row, width, point_length(body, scene));
  };
  Sample s;
  s.time = body.time;
  s.front = experiment::front_of(body.points, box.column_length, body.grid.axes[0].h);
  s.h1 = depth_over(behind_the_gate(box));
  if (s.front > box.channel_length - 0.5 * off_the_walls) s.h2 = depth_over(at_the_end(box));
  s.max_speed = step.max_speed;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = experiment::mean_flocculation(body.points);
  s.volume_change = experiment::volume_change(body.points);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  return s;
}

/// Depths along the channel, a station a cell, and the volume below its ceiling. A depth is the mean of four cells:
/// single cells hold one point more or less, which is no shape of the concrete.
template <class Geometry>
void read_profile(const Body<Geometry>& body, const Scene& scene, Results& r) {
  const Box& box = scene.box;
  const double h = body.grid.axes[0].h, reach = 2.0 * h, row = body.grid.axes[Geometry::up].h;
  const double width = computed_width(scene);
  for (double x = reach; x < box.channel_length - reach + 0.5 * h; x += h) {
    const double at = box.column_length + x;
    r.profile.push_back(
        {x, depth<Geometry>(body.points, at - reach, at + reach, row, width, point_length(body, scene))});
  }
  double volume = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    if (body.points.x[p][0] >= box.column_length && body.points.x[p][Geometry::up] < box.channel_height)
      volume += body.points.volume(p);
  r.volume_in_channel = volume / width * box.width;
}

}  // namespace tremie::boxes
