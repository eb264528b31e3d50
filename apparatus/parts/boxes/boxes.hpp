#pragma once

// A box with a gate, in the plane along it or in space: a column of concrete that flows under a wall into what lies beyond
// when the gate is lifted. An L-box has a channel there, a U-box a second shaft. Without bars or with some in front of the gate,
// which a section averages over the width. In the plane the concrete may be poured where the column would stand, as into the LCPC box.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/apparatus.hpp"
#include "apparatus/common/model.hpp"
#include "apparatus/run/record.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::boxes {

/// Inner dimensions [m], by default EN 12350-10's. The channel begins at the gate.
struct Box {
  double column_length = 0.10;
  double column_height = 0.60;
  double channel_length = 0.70;
  double channel_height = 0.15;
  double width = 0.20;
  double bar_diameter = 0.012;
};

/// A pour in place of a column that stands there.
struct Pour {
  double volume = 6e-3;  ///< [m^3]
  double time = 30.0;    ///< that it takes [s]
  double fall = 0.0;     ///< from the bucket's lip down to the floor [m]; 0: it is laid down at rest
};

/// So stiff that a column of 0.6 m compresses by less than 0.2 % under its own weight [Pa]: rho g H / 2 K.
inline constexpr double default_bulk_modulus = 5e6;

/// A checked scene, SI units.
struct Scene {
  Mix mix = {.K = default_bulk_modulus, .thixotropy = {}};
  Box box;
  double rest = 60.0;                       ///< in the column, before the gate is lifted [s]
  double duration = 180.0;                  ///< of the flow, at most [s]
  std::optional<Pour> pour = {};            ///< in the plane alone; the column is what lies there at time 0
  std::optional<double> gate_speed = 0.30;  ///< [m/s]; empty: the gate is gone at once
  WallLaw walls = NoSlip{};                 ///< floor, ends, front wall, gate and side walls
  int bars = 0;                             ///< in front of the gate
  Model model;
  double frame_interval = 0.0;  ///< simulated time between frames [s]; 0: chosen (run/run_loop.hpp)
  int threads = 1;
  /// Against velocities that alternate from node to node (libmpm/implicit/problem/yield_problem.hpp), in plastic
  /// viscosities; no scene key, for studies.
  double alternating_viscosity = 100.0;
  bool side_walls_slip = false;  ///< in space; no scene key, for studies
};

/// One line of timeseries.csv.
struct Sample {
  double time = 0.0;              ///< since the start of the lift [s]
  double front = 0.0;             ///< distance of the front from the gate [m], 0 behind it
  double h1 = 0.0;                ///< depth behind the gate, as reading.hpp has it [m]
  std::optional<double> h2;       ///< depth at the channel's end [m]; empty before the front is there
  double through_the_wall = 0.0;  ///< share of the volume that has gone through gate or front wall so far
  double max_speed = 0.0;         ///< [m/s]
  double shear_rate_mean = 0.0;   ///< volume mean [1/s]
  std::optional<double> flocculation_mean;
  double volume_change = 0.0;  ///< sum V / V0 - 1
  double time_step = 0.0;      ///< [s]
  int iterations = 0;
};

struct Results {
  double h1 = 0.0;                          ///< [m]
  std::optional<double> h2, passing_ratio;  ///< empty where the concrete never reached the end
  std::optional<double> ratio_change;       ///< of the passing ratio over the last standing_lasts [1/s]
  std::optional<double> t200, t400;         ///< front 200 and 400 mm from the gate [s]
  std::optional<double> stopped_at;         ///< [s]
  std::optional<double> flocculation_mean_start, flocculation_mean_end;
  std::vector<std::array<double, 2>> profile;  ///< distance from the gate and depth at the end [m]
  double volume_in_channel = 0.0;              ///< at the end, over the whole width [m^3]
};

using Outcome = experiment::Record<Results, Sample>;

/// What a person who waits is told of a line.
using ProgressText = std::string (*)(const Sample& now);
std::string front_text(const Sample& now);

/// Runs the test; as cone::run.
Outcome run(const Scene& scene, const scene::Observer& observer = {}, ProgressText text = front_text);

scene::SizeEstimate estimate(const Scene& scene);

/// Cells must resolve the column and the gate, and the points must fit into a computer; throws InputError where they do not.
void check_cells(const scene::Values& values, const Scene& scene);

/// Whether the box is computed in three dimensions.
bool in_space(const Scene& scene);

/// Refuses a box.width that is too narrow for so many bars of a diameter [m]: they need three diameters from one to the next, the
/// least spacing for which a row's drag is known.
void check_width(const scene::Values& values, int bars, double bar_diameter);
/// Width of the gaps between the bars, and between them and the side walls [m].
double gap_between_bars(const Scene& scene);

}  // namespace tremie::boxes
