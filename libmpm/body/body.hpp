#pragma once

// A body of concrete on its grid: plain data, whatever the scheme that steps it.

#include <vector>

#include "libmpm/boundary/boundary_points.hpp"
#include "libmpm/boundary/flat_walls.hpp"
#include "libmpm/boundary/slender_bars.hpp"
#include "libmpm/constitutive/mix.hpp"
#include "libmpm/transfer/apic.hpp"

namespace tremie {

/// A body of concrete on its grid: everything that a step reads and writes.
template <class Geometry>
struct Body {
  static constexpr int D = Geometry::dim;
  Mix mix;                   ///< of all points; with `mixes` it gives density, K and the scale of tolerances
  std::vector<Mix> mixes{};  ///< by Points::mix, of one density, K and kinetics; empty: mix
  Vec<D> gravity = Vec<D>::Zero();  ///< [m/s^2]
  Points<D> points;
  ActiveGrid<D> grid;
  Motion<Geometry> motion{};               ///< of the points
  WallVelocities<D> walls{};               ///< of the walls at the ends of the axes
  std::vector<BoundaryPoint<D>> boundary;  ///< walls inside the grid
  std::vector<BarPoint<D>> bars{};         ///< thinner than the grid resolves
  double time = 0.0, dt = 0.0;             ///< [s]; dt of the last step

  NodalState<D> nodes;             ///< of the last step, velocities at its start (implicit: with gravity)
  std::vector<Vec<D>> v;           ///< nodal velocities at the end of the last step [m/s]
  double dissipation = 0.0;        ///< power of the stresses in the last step [W; W/m], if asked for
  std::vector<Vec<D>> wall_force;  ///< of the flat walls on each node in the last step [N; N/m], if asked for

  const Mix& mix_of(std::size_t p) const {
    return mixes.empty() ? mix : mixes[static_cast<std::size_t>(points.mix[p])];
  }
};

}  // namespace tremie
