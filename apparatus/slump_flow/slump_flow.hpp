#pragma once

// The slump-flow test of EN 12350-8: an Abrams cone of concrete, lifted off a floor, and the spread that it
// leaves.

#include <atomic>
#include <functional>
#include <optional>

#include "apparatus/common/checkpoints.hpp"
#include "apparatus/common/model.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::slump_flow {

/// EN 12350-2's cone, inner dimensions [m].
struct Cone {
  double top_radius = 0.05;
  double bottom_radius = 0.10;
  double height = 0.30;
};

/// A checked scene, SI units.
struct Scene {
  Mix mix;
  Cone cone;
  Floor floor;
  double rest = 0.0;                        ///< before the lift [s]
  double duration = 30.0;                   ///< of the flow, at most [s]
  std::optional<double> lift_speed = 0.15;  ///< [m/s]; empty: the cone is gone at once
  Model model;
  double frame_interval = 0.0;  ///< simulated time between frames [s]; 0: chosen (run/run_loop.hpp)
  int threads = 1;
};

/// One line of timeseries.csv.
struct Sample {
  double time = 0.0;                             ///< since the start of the lift [s]
  double spread = 0.0;                           ///< as the standard reads it [m]
  double spread_max_point = 0.0;                 ///< twice the outermost point's radius [m]
  double height = 0.0;                           ///< of the concrete at the centre [m]
  double max_speed = 0.0;                        ///< [m/s]
  double shear_rate_mean = 0.0;                  ///< volume mean [1/s]
  std::optional<double> flocculation_mean = {};  ///< volume mean; empty without thixotropy
  double volume_change = 0.0;                    ///< sum V / V0 - 1
  double kinetic_energy = 0.0;                   ///< [J]
  double time_step = 0.0;                        ///< [s]
  int iterations = 0;                            ///< of the yield method in this step
};

struct Results {
  double spread = 0.0, spread_max_point = 0.0, height = 0.0;  ///< [m]
  std::optional<double> t500 = {};                            ///< [s], from the start of the lift
  std::optional<double> stopped_at = {};                      ///< [s]
  std::optional<double> flocculation_mean_start = {}, flocculation_mean_end = {};
  double shear_rate_mean_peak = 0.0;         ///< [1/s]
  std::optional<double> mean_velocity = {};  ///< (SF - 200 mm) / (2 t_stop) [m/s]
  /// Share of the volume behind the wall of the cone when its rim has risen by a cell, or at the end.
  std::optional<double> through_the_cone = {};
};

struct Outcome {
  Status status = Status::completed;
  Results results;
  Checks checks;
  Cost cost;
  std::vector<Sample> series;  ///< every step, the start included
  Frame final_frame;
};

/// What a caller may want to see while a run goes on. Every member may be empty.
struct Observer {
  std::function<void(const Sample&)> on_step;
  std::function<void(const Frame&)> on_frame;  ///< at the start, every frame_interval and at the end
  const std::atomic<bool>* interrupted = nullptr;
  const Checkpoints* checkpoints = nullptr;
};

/// What a run of this scene would carry: for `tremie check`.
struct Estimate {
  std::int64_t points = 0, cells_active = 0, bytes_per_point = 0;
  std::int64_t steps = 0, steps_expected = 0;  ///< at most; and where the flow is expected to come to rest
  double time_expected = 0.0;                  ///< [s] of the test until then
  double point_step = 0.0;                     ///< CPU of a step by the point, measured [s]
};

/// Runs the test. Numerical trouble is reported in Outcome::checks, not thrown; a scene that this library
/// cannot run (an explicit scheme, a space without an engine) throws std::invalid_argument with the reason.
Outcome run(const Scene& scene, const Observer& observer = {});

/// Points, cells and bytes at the start and a guess of the steps, without running.
Estimate estimate(const Scene& scene);

/// EN 12350-8 class of a spread [m] rounded to 10 mm: "SF1", "SF2", "SF3"; "" outside of all.
std::string spread_class(double spread);

}  // namespace tremie::slump_flow
