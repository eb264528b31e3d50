#pragma once

// What every scene may choose about the model, and what every run reports about itself. Plain data, SI units.
// The TOML keys are described in docs/reference/scenes.md, the JSON keys in docs/reference/results.md.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libmpm/boundary/wall_law.hpp"
#include "libmpm/constitutive/laws/yield_law.hpp"

namespace tremie {

enum class SpaceKind {
  axisymmetric,
  quarter,
  full,
  plane,
  plane_with_side_walls,
  couette,
  half,
  cylindrical
};
enum class SchemeKind { implicit, explicit_usl, explicit_usf };
enum class MethodKind { automatic, admm, newton };
enum class ShapeKind { b_spline, gimp };
enum class PressureKind { cell, point };
enum class TransferKind { apic, flip };
enum class PrecisionKind { both_double, single_sums };

struct Floor {
  WallLaw contact = NoSlip{};
};

struct Model {
  SpaceKind space = SpaceKind::axisymmetric;
  YieldLaw law = ExactBingham{};
  SchemeKind scheme = SchemeKind::implicit;
  MethodKind method = MethodKind::automatic;
  ShapeKind shape = ShapeKind::b_spline;
  PressureKind pressure = PressureKind::cell;  ///< one divergence a cell or a point, explicit schemes alone
  TransferKind transfer = TransferKind::apic;
  PrecisionKind precision = PrecisionKind::both_double;  ///< of points and sums, explicit schemes alone
  double flip_blend = 0.95;                              ///< share of FLIP, transfer = flip alone
  std::optional<double> time_step;                       ///< fixed step [s]; empty: chosen at every step
  double step_scale = 1.0;  ///< on the longest step that is chosen; no scene key, for error estimates
  std::array<double, 2> cell = {0.01, 0.005};  ///< [m] across, up
  bool particle_shifting =
      true;  ///< keep cells inside the body full (libmpm/implicit/shifting/particle_shifting.hpp); no scene key, for studies
  std::array<int, 2> points_per_cell = {4, 4};  ///< across, up
};

/// What makes a result trustworthy, or not (summary.json, "checks").
struct Checks {
  double volume_change = 0.0;  ///< sum V / V0 - 1
  double mass_error = 0.0;     ///< relative
  std::int64_t unconverged_steps = 0;
  std::int64_t points_lost = 0;
  double max_speed_end = 0.0;  ///< [m/s]
  bool stability_limit_exceeded = false;
  bool stood_still = false;          ///< a body that was free to fall has not moved
  double cells_in_a_step = 0.0;      ///< the most that a point crossed, where the scene fixes the step
  std::vector<std::string> reasons;  ///< why the result is not to be trusted; empty: it is
};

/// What a run cost (summary.json, "cost"); wall, CPU and peak memory are filled in by
/// apparatus/registry.
struct Cost {
  double wall = 0.0, cpu = 0.0;  ///< [s]
  std::int64_t steps = 0;
  std::int64_t points = 0;
  std::int64_t cells_active = 0;  ///< the largest number over the run
  std::int64_t bytes_per_point = 0;
  std::int64_t peak_rss_bytes = 0;
  int threads = 1;
  double simulated = 0.0;  ///< [s]
};

enum class Status { completed, interrupted, failed };

/// The points at one time, for results.h5 and the frames. Axisymmetric points lie in the plane (r, 0, z).
struct Frame {
  double time = 0.0;
  std::vector<std::array<double, 3>> position;  ///< [m]
  std::vector<std::array<double, 3>> velocity;  ///< [m/s]
  std::vector<double> volume;                   ///< [m^3]
  std::vector<double> pressure;                 ///< [Pa]
  std::vector<double> shear_rate;               ///< [1/s]
  std::vector<double> flocculation;             ///< empty without thixotropy
  std::vector<double> age = {};                 ///< since batching [s]; empty where loads are not told apart
  std::vector<double> load = {};                ///< number of the load, from 1; likewise
};

}  // namespace tremie
