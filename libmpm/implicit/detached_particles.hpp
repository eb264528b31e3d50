#pragma once

// Drops in the air. A drop that falls off a wall is faster than the concrete that stands below it, and if it
// set the step, a few points would make the whole body wait. A scene may say which share of the points can be
// drops: they do not count for the step, and none of them moves more than a cell in it. A faster one is
// slowed down to that, as if the air held it; its momentum is lost, which is why the share must be small.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "libmpm/grid/axis.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// Cells that a displacement crosses, in the direction in which it crosses most.
template <int D>
double cells_crossed(const std::array<Axis, D>& axes, const Vec<D>& displacement) {
  double cells = 0.0;
  for (int d = 0; d < D; ++d) cells = std::max(cells, std::abs(displacement[d]) / axes[d].h);
  return cells;
}

/// Takes back what points moved from `from` beyond a cell in any direction over dt, and slows them down to a cell a step.
/// One that the floor stopped has moved less than its speed times dt, and only what it moved is taken back.
template <int D>
void hold_detached_particles(const std::array<Axis, D>& axes, double dt, const std::vector<Vec<D>>& from,
                             Points<D>& points) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double cells = cells_crossed<D>(axes, dt * points.v[p]);
    if (cells <= 1.0) continue;
    const Vec<D> moved = points.x[p] - from[p];
    points.x[p] = from[p] + moved / std::max(1.0, cells_crossed<D>(axes, moved));
    points.v[p] /= cells;
    points.C[p] /= cells;
  }
}

}  // namespace tremie
