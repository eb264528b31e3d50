#pragma once

// A funnel full of concrete whose mouth opens at time 0: V-funnel, inverted cone, Orimet. The concrete falls out of the
// mouth and leaves the run below it; what is read is when light is seen through the mouth from above.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/apparatus.hpp"
#include "apparatus/common/flow_readings.hpp"
#include "apparatus/common/model.hpp"
#include "apparatus/parts/funnel/shape.hpp"
#include "apparatus/run/record.hpp"
#include "libmpm/boundary/openings/outlet.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::funnel {

/// So stiff that 0.6 m of concrete is compressed by less than 0.1 % on average under its own weight [Pa].
inline constexpr double default_bulk_modulus = 1e7;

/// A checked scene, SI units.
struct Scene {
  Mix mix = {.K = default_bulk_modulus, .thixotropy = {}};
  Shape shape;
  double rest = 0.0;       ///< before the mouth opens [s]
  double duration = 60.0;  ///< of the flow, at most [s]
  WallLaw walls = NoSlip{};
  Model model;
  double frame_interval = 0.0;  ///< simulated time between frames [s]; 0: chosen (run/run_loop.hpp)
  int threads = 1;
};

/// One line of timeseries.csv.
struct Sample {
  double time = 0.0;             ///< since the mouth opened [s]
  double emptied = 0.0;          ///< share of the concrete that has left
  double discharge = 0.0;        ///< over the last tenth of a second, or since the start [m^3/s]
  double height = 0.0;           ///< of the concrete at the axis, over the mouth [m]
  double max_speed = 0.0;        ///< [m/s]
  double shear_rate_mean = 0.0;  ///< volume mean of what is left [1/s]
  std::optional<double> flocculation_mean;
  double volume_change = 0.0;  ///< sum V / V0 - 1 of what is left
  double time_step = 0.0;      ///< [s]
  int iterations = 0;
};

struct Results {
  std::optional<double> flow_time;  ///< until light is seen through the mouth [s]
  double emptied = 0.0;  ///< share of the concrete that has passed the mouth by then, or in the whole run
  std::optional<double> stopped_at;  ///< where its yield stress holds it [s]
  double volume = 0.0;               ///< of the concrete in the funnel at the start [m^3]
  double volume_error = 0.0;         ///< what has left and what is left, over the volume at the start, less 1
};

using Outcome = experiment::Record<Results, Sample>;

/// Runs the test; as cone::run.
Outcome run(const Scene& scene, const scene::Observer& observer = {});

scene::SizeEstimate estimate(const Scene& scene);

/// How far below the mouth the concrete leaves the run [m].
double drop_below_mouth(const Scene& scene);

/// A test with a funnel.
struct FunnelTest {
  const char *name, *words;  ///< apparatus = "name", a file of reference_data/funnels too; and for people
  const char* help;
  Shape standard;             ///< as in that file; with a depth: a plane section between side walls
  const char* cell = "5 mm";  ///< by default
};

/// The keys of such a test, and the checked values as a scene; throws InputError where they do not fit each other.
scene::ApparatusKeys keys(const FunnelTest& test);
Scene read_scene(const scene::Values& values);

using View = scene::RunView<Scene, Outcome>;

/// The rows of flow time, share that has left, and how the run went.
scene::Rows<View> flow_rows();
scene::Rows<View> course_rows();

/// Adds the reasons of all checks.
void add_reasons(const Scene& scene, Outcome& outcome);

/// The apparatus of a test with a table of readings; `finish` says what else there is to say of an outcome.
scene::Apparatus apparatus_of(const FunnelTest& test, const std::vector<scene::Reading<View>>& table,
                              void (*finish)(const View&, scene::Outcome&) = nullptr);

}  // namespace tremie::funnel
