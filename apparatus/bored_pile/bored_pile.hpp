#pragma once

// The pour of a bored pile or of a panel of a diaphragm wall through a tremie pipe: a section of it, the concrete entering at the
// pipe's mouth load after load, the pipe withdrawn in pieces.

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/apparatus.hpp"
#include "apparatus/run/record.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::bored_pile {

struct Load {
  double volume = 0.0;             ///< [m^3]
  double age = 0.0;                ///< since batching, when it is placed [s]
  double pause = 0.0, rest = 0.0;  ///< before it is placed: of the pour; without agitation [s]
};

struct Pipe {
  double inner_radius = 0.125, outer_radius = 0.135;  ///< [m]
  double least = 2.0, most = 6.0;                     ///< embedment [m]
  double pull = 3.0, start = 0.25,
         above = 2.0;  ///< pulled at a time; mouth over the base at first; top over the pile's [m]
};

/// Reinforcement: upright bars on a circle, with hoops around them.
struct Cage {
  double radius = 0.0;         ///< of the circle through the bars' axes [m]
  int bars = 0;                ///< on it
  double bar_diameter = 0.0;   ///< [m]
  double hoop_spacing = 0.0;   ///< [m]; 0: no hoops
  double hoop_diameter = 0.0;  ///< [m]
  double bar_spacing() const { return 2.0 * std::numbers::pi * radius / bars; }
};

/// A checked scene, SI units.
struct Scene {
  Mix mix;
  double radius = 0.75, depth = 16.0;  ///< of the pile; half the length of a panel [m]
  double width = 0.0;                  ///< of a panel, whose section is a plane [m]; 0: a pile
  Pipe pipe;
  double fluid_density = 1100.0;  ///< [kg/m^3]
  double rate = 27.0 / 3600.0;    ///< of the pour [m^3/s]
  double workable = 14400.0;      ///< age up to which the concrete is [s]
  std::vector<Load> loads;
  std::vector<Mix> mixes = {};  ///< of the loads; empty: mix
  std::optional<Cage> cage = {};
  WallLaw walls = NoSlip{};
  Model model;
  double frame_interval = 0.0, rest = 0.0;  ///< [s]
  int threads = 1;
};

/// One line of timeseries.csv.
struct Sample {
  double time = 0.0, time_step = 0.0;                                          ///< [s]
  double volume = 0.0;                                                         ///< placed [m^3]
  double level = 0.0, level_pipe = 0.0, level_middle = 0.0, level_wall = 0.0;  ///< over the pile's base [m]
  std::optional<double> level_step = {};     ///< inside the cage less outside [m]
  double mouth = 0.0, pressure_mouth = 0.0;  ///< [m], [Pa]
  std::optional<double> head =
      {};             ///< needed in the pipe above its mouth while it flows [m]; infinite: none pushes it
  double load = 1.0;  ///< that is placed, from 1
  double surface_stress = 0.0;                    ///< largest static yield stress of the surface [Pa]
  double max_speed = 0.0, shear_rate_mean = 0.0;  ///< [m/s], [1/s]
  std::optional<double> flocculation_mean = {};
  double volume_change = 0.0;  ///< sum V / V0 - 1
  int iterations = 0;
};

/// The concrete along the wall, in a cell.
struct AtWall {
  double height = 0.0, pressure_max = 0.0, pressure_end = 0.0;  ///< [m], [Pa]
  double hydrostatic = 0.0;                                     ///< at the end [Pa]
  double flocculation = 0.0, age = 0.0;                         ///< at the end; [s]
};

struct Results {
  double level_end = 0.0, volume_error = 0.0;  ///< [m]; level against volume
  std::optional<double> head_needed = {};      ///< largest [m]; empty: no head pushes it
  bool head_suffices = true;
  double plug_share = 0.0;                ///< of the first load in the top metre
  std::vector<double> cover;              ///< share of each load in the cover
  std::optional<double> level_step = {};  ///< inside the cage less outside, mean while it flows [m]
  double pressure_max = 0.0;              ///< on the wall [Pa]
  double oldest_at_surface = 0.0;         ///< [s]
  double placed = 0.0;                    ///< [m^3]
  std::vector<AtWall> wall = {};
  bool washed = false;                    ///< the mouth came within a cell of the surface
  std::optional<double> stopped_at = {};  ///< [m] level where the head did not suffice
};

using Record = experiment::Record<Results, Sample>;

inline const Mix& mix_of(const Scene& scene, std::size_t load) {
  return scene.mixes.empty() ? scene.mix : scene.mixes[load];
}

/// Depth of the cover [m]: what lies outside the cage, or 75 mm where there is none.
inline double cover_depth(const Scene& scene) {
  return scene.cage ? scene.radius - scene.cage->radius - 0.5 * scene.cage->bar_diameter : 0.075;
}

/// Area of the bore within x of its middle [m^2].
inline double area_within(const Scene& scene, double x) {
  return scene.width > 0.0 ? 2.0 * scene.width * x : std::numbers::pi * x * x;
}
/// Volume of the bore over that of the section: a panel's is one half of it, a metre wide.
inline double whole(const Scene& scene) { return scene.width > 0.0 ? 2.0 * scene.width : 1.0; }
/// How far the pipe's outside reaches from the middle [m]. In a panel the pipe is a slot of its area, across the whole width.
inline double pipe_reach(const Scene& scene) {
  const double r = scene.pipe.outer_radius;
  return scene.width > 0.0 ? std::numbers::pi * r * r / (2.0 * scene.width) : r;
}

/// Volume that the pile holds with the pipe out of it [m^3].
double pile_volume(const Scene& scene);
/// Until all loads are placed [s].
double pour_time(const Scene& scene);

scene::ApparatusKeys keys();
Scene read_scene(const scene::Values& values);

/// Runs the pour; as cone::run.
Record run(const Scene& scene, const scene::Observer& observer = {});
scene::SizeEstimate estimate(const Scene& scene);

scene::Apparatus apparatus();

}  // namespace tremie::bored_pile
