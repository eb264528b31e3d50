#pragma once

// Concrete that is poured into a section of a box instead of standing there from the start. It comes onto the surface over the
// column's length, row by row, with the speed of its free fall there. The falling jet is not computed: it is a millimetre thick.

#include <algorithm>
#include <cmath>
#include <vector>

#include "apparatus/parts/boxes/reading.hpp"

namespace tremie::boxes {

/// How far a pour is.
struct Poured {
  double section = 0.0;  ///< of what left the bucket [m^2]
  double waiting = 0.0;  ///< of it, what no points hold yet [m^2]
};

/// Speed on a surface of what fell freely from the bucket [m/s].
inline double speed_of_fall(const Pour& pour, double surface) {
  return std::sqrt(2.0 * experiment::gravity * std::max(0.0, pour.fall - surface));
}

/// A row of points of this height [m] on the surface. None is laid near the end wall, where it would stick to the wall.
inline void lay_row(const Scene& scene, double height, Body<PlaneStrain>& body) {
  auto& points = body.points;
  const double from = off_the_walls, length = scene.box.column_length - from;
  const double apart = point_length(body, scene), row = scene.model.cell[1] / scene.model.points_per_cell[1];
  const int n = std::max(1, static_cast<int>(std::lround(length / apart)));
  std::vector<double> top(static_cast<std::size_t>(n), 0.0);
  for (const Vec<2>& x : points.x) {
    const double column = (x[0] - from) / length * n;
    if (column < 0.0 || column >= n) continue;
    double& highest = top[static_cast<std::size_t>(column)];
    highest = std::max(highest, x[1] + 0.5 * row);
  }
  Body<PlaneStrain> laid;
  laid.mix = body.mix;
  for (int i = 0; i < n; ++i) {
    const double V = length / n * height, y = top[static_cast<std::size_t>(i)] + 0.5 * height;
    add_point<2>(points, {from + (i + 0.5) * length / n, y}, body.mix.density * V, V, 0.0);
    if (const double speed = speed_of_fall(*scene.pour, y); speed > 0.0) points.v.back()[1] = -speed;
    add_point<2>(laid.points, Vec<2>::Zero(), 0.0, 0.0, 0.0);
  }
  experiment::rest(laid, scene.rest);
  const auto join = [](std::vector<double>& to, const std::vector<double>& from_laid) {
    to.insert(to.end(), from_laid.begin(), from_laid.end());
  };
  join(points.lambda, laid.points.lambda), join(points.gamma_dot, laid.points.gamma_dot);
  for (std::size_t k = 0; k < points.lambda_parts.size(); ++k)
    join(points.lambda_parts[k], laid.points.lambda_parts[k]);
}

/// Lays what the bucket gave until now. The last row is as high as what is left.
inline void let_in(const Scene& scene, Poured& poured, Body<PlaneStrain>& body) {
  const double whole = scene.pour->volume / scene.box.width;
  const double due = std::min(1.0, body.time / scene.pour->time) * whole,
               came = std::max(0.0, due - poured.section);
  const double length = scene.box.column_length - off_the_walls;
  const double row = scene.model.cell[1] / scene.model.points_per_cell[1];
  poured.section += came, poured.waiting += came;
  for (; poured.waiting >= length * row; poured.waiting -= length * row) lay_row(scene, row, body);
  if (due < whole || poured.waiting <= 1e-9 * length * row) return;
  lay_row(scene, poured.waiting / length, body);
  poured.waiting = 0.0;
}

}  // namespace tremie::boxes
