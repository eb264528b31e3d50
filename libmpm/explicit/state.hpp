#pragma once

// What an explicit step needs beside the body: its settings, the points side by side on their tiles, and what
// it reports.

#include <cstdint>
#include <optional>

#include "libmpm/body/body.hpp"
#include "libmpm/boundary/wall_law.hpp"
#include "libmpm/explicit/stability_limits.hpp"
#include "libmpm/explicit/tiled_particles.hpp"
#include "libmpm/transfer/shape_functions.hpp"

namespace tremie {

enum class StressUpdate {
  last,  ///< USL: with the velocities at the end of the step, which also move the points
  first  ///< USF: with the velocities of the points brought back to the grid, before the forces
};

struct ExplicitSettings {
  StressUpdate stress = StressUpdate::last;
  Transfer transfer;
  bool cell_pressure = true;       ///< one divergence and one pressure row a cell, against locking
  bool single_precision = false;   ///< shape functions, sums and the law
  bool keep_affine = true;         ///< affine velocities in the points: no step reads them there
  bool keep_shear_rates = false;   ///< in the points, where thixotropy does not need them
  std::optional<double> fixed_dt;  ///< [s]; empty: `safety` times the stability limit
  double safety = 0.8;
  double dt_max = 0.01;     ///< [s]
  double cfl = 0.2;         ///< largest move in a step of a chosen length, in cells
  WallLaw wall_law;         ///< along faces of FaceKind::wall_law
  double wall_gap = 0.0;    ///< how near a point may come to a rigid wall [m]
  double wall_speed = 0.0;  ///< of a rigid wall, at most [m/s]
};

struct ExplicitReport {
  double dt = 0.0;              ///< [s]
  StabilityLimits limits = {};  ///< at the start of the step
  bool beyond_limit = false;    ///< dt was longer than one of them
  bool failed = false;     ///< a point moved half a cell, or is not finite, or has left what its tile sees
  double max_speed = 0.0;  ///< of the points [m/s]
  double shear_rate_mean = 0.0;  ///< volume mean [1/s]
};

/// A cell at a wall that holds the concrete (wall_fill.hpp).
template <int D>
struct HeldCell {
  float hold;                  ///< what its points stand for, in units of their own volume
  std::array<float, D> place;  ///< of its pressure row: as far from the wall as the points on average
};
template <int D>
using HeldCells = std::array<HeldCell<D>, power(tile_pressure_cells, D)>;  ///< of a tile

template <int D>
struct Holding {
  std::vector<int> of_tile;  ///< where the tile's cells are in `cells`; -1: no such wall near
  std::vector<HeldCells<D>> cells;
  double drift = 1e300;  ///< of the points since they were found, in cells

  const HeldCells<D>* of(int tile) const {
    const int at = of_tile[tile];
    return at < 0 ? nullptr : &cells[at];
  }
};

/// The body on its tiles. body.points is what it was at the last write_back, and empty before the first.
template <class Geometry>
struct ExplicitState {
  static constexpr int D = Geometry::dim;
  Shape<D> shape;
  LanePoints<D> points;
  TileGrid<D> grid;
  double next_dt = 0.0;     ///< of the step to come [s]
  double drift = 0.0;       ///< no point is further from where it was sorted, in cells
  double max_speed = 0.0;   ///< of the points [m/s]
  double lambda_max = 0.0;  ///< largest flocculation in a point
  StabilityLimits limits;
  Holding<D> holding;
  std::vector<std::array<int, 3>> near_wall;  ///< tile, group and lane of what may touch a rigid wall soon
  double wall_drift = 1e300;                  ///< since they were looked for [m]
  std::int64_t sorts = 0;
};

/// Brings the state of the points to body.points.
template <class Geometry>
void write_back(ExplicitState<Geometry>& state, Body<Geometry>& body) {
  write_back<Geometry::dim>(state.points, state.grid.axes, body.points);
}

namespace detail {

/// How far points may drift, in cells, before they are sorted anew: a step may add half a cell, and a tile sees one
/// beyond its own. Rows that follow the points miss what has come into their cell from the next tile: sooner for them.
inline double drift_allowed(const ExplicitSettings& settings) {
  return settings.stress == StressUpdate::last && settings.cell_pressure ? 0.1 : 0.45;
}

}  // namespace detail
}  // namespace tremie
