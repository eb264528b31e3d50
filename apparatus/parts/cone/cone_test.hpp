#pragma once

// A cone of concrete that is lifted off a floor: the slump flow of EN 12350-8 and, with a ring of bars about it, EN 12350-12.

#include <optional>
#include <string>

#include "apparatus/common/apparatus.hpp"
#include "apparatus/common/model.hpp"
#include "apparatus/run/record.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::cone {

/// EN 12350-2's cone, inner dimensions [m].
struct Cone {
  double top_radius = 0.05;
  double bottom_radius = 0.10;
  double height = 0.30;
};

/// Volume of concrete that it holds [m^3].
double volume(const Cone& cone);
/// How large it is beside the Abrams cone: the cube root of their volumes' ratio, 1 to the last digit for that cone.
double scale_of(const Cone& cone);
/// Whether it is the Abrams cone within what EN 12350-2 allows, 2 mm; `either_way`: upside down too (ASTM C1611, B).
bool is_abrams(const Cone& cone, bool either_way = false);

/// Bars upright on the floor, evenly on a circle about the cone.
struct Ring {
  int bars = 16;
  double bar_diameter = 0.018;  ///< [m]
  double diameter = 0.300;      ///< of the circle through the bars' middles [m]
  double height = 0.100;        ///< of the bars [m]
};

/// A checked scene, SI units.
struct Scene {
  Mix mix;
  Cone cone;
  Floor floor;
  double rest = 0.0;              ///< before the lift [s]
  double duration = 30.0;         ///< of the flow, at most [s]
  double rest_tolerance = 0.002;  ///< it has stopped when it would gain less than this share of its spread
  std::optional<double> lift_speed = 0.15;  ///< [m/s]; empty: the cone is gone at once
  std::optional<Ring> ring;                 ///< in space alone
  Model model;
  double film_cell =
      0.005;  ///< height of the cells of a section once the body creeps, for its depth at rest [m]
  double film_spread = 0.52;    ///< from which it gets them [m]
  double frame_interval = 0.0;  ///< simulated time between frames [s]; 0: chosen (run/run_loop.hpp)
  int threads = 1;
};

/// Height of a section's cells once the body creeps [m]. Cells of a scene's own are as flat, to the default, as they were.
double film_cell_of(const Scene& scene);

/// Spread [m] from which a section gets cells of that height: wider than 520 mm out of the Abrams cone, and at most twice as
/// deep as it will rest.
double film_spread_of(const Scene& scene);

/// One line of timeseries.csv.
struct Sample {
  double time = 0.0;                             ///< since the start of the lift [s]
  double spread = 0.0;                           ///< as the standard reads it [m]
  double spread_max_point = 0.0;                 ///< twice the outermost point's radius [m]
  double height = 0.0;                           ///< of the concrete at the centre [m]
  double reach = 0.0;                            ///< mean distance of the concrete from the axis [m]
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
  std::optional<double> step = {};           ///< mean height inside the ring less that just outside of it [m]
  double height_scale = 1.0;  ///< of readings of the height, which leave out the topmost points
  /// Share of the volume behind the wall of the cone when its rim has risen by a cell, or at the end.
  std::optional<double> through_the_cone = {};
};

using Outcome = experiment::Record<Results, Sample>;

/// Runs the test. Numerical trouble is reported in Outcome::checks, not thrown; a scene that this library
/// cannot run (an explicit scheme, a space without an engine) throws std::invalid_argument with the reason.
Outcome run(const Scene& scene, const scene::Observer& observer = {});

/// Points, cells and bytes at the start and a guess of the steps, without running.
scene::SizeEstimate estimate(const Scene& scene);

/// When the spread passed a diameter [m], from the start of the lift [s]; empty where it never did.
std::optional<double> time_to_spread(const std::vector<Sample>& series, double diameter);

/// EN 206's class of a spread [m] read to 10 mm: "SF1", "SF2", "SF3"; "" outside of all.
std::string spread_class(double spread);

/// EN 206's class of a slump [m] read to 10 mm: "S1" to "S5"; "" below 10 mm.
std::string slump_class(double slump);

}  // namespace tremie::cone
