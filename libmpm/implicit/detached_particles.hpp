#pragma once

// Drops in the air. A drop that falls off a wall is faster than the concrete that stands below it, and if it
// set the step, a few points would make the whole body wait. A scene may say which share of the points can be
// drops: they do not count for the step, and none of them moves more than a cell in it. A faster one is
// slowed down to that, as if the air held it; its momentum is lost, which is why the share must be small.

#include <algorithm>
#include <array>
#include <cmath>

#include "libmpm/grid/axis.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// Takes back what points moved beyond a cell in any direction over dt, and slows them down to it.
template <int D>
void hold_detached_particles(const std::array<Axis, D>& axes, double dt, Points<D>& points) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    double cells = 0.0;
    for (int d = 0; d < D; ++d) cells = std::max(cells, std::abs(points.v[p][d]) * dt / axes[d].h);
    if (cells <= 1.0) continue;
    points.x[p] -= (1.0 - 1.0 / cells) * dt * points.v[p];
    points.v[p] /= cells;
    points.C[p] /= cells;
  }
}

}  // namespace tremie
