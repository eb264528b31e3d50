#pragma once

// The state of a pour: the concrete with what it remembers of its loads, the pipe, and the schedule.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "apparatus/bored_pile/bored_pile.hpp"
#include "libmpm/boundary/openings/inlet.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "libmpm/implicit/steady/foot.hpp"
#include "libmpm/implicit/step.hpp"

namespace tremie::bored_pile {

/// A stretch of the schedule.
struct Phase {
  double begin = 0.0, end = 0.0;  ///< [s]
  double rate = 0.0;              ///< [m^3/s]
  double before = 0.0;            ///< volume placed when it begins [m^3]
};

/// Of a pile, Axisymmetric, or a panel, PlaneStrain.
template <class Section>
struct Pour {
  ImplicitBody<Section> body;
  std::vector<double> load, batched;  ///< of each point: its load from 1; when it was batched [s]
  Inlet inlet;
  std::vector<Phase> phases;
  double placed = 0.0;        ///< volume that left the pipe [m^3]
  double first_charge = 0.0;  ///< of it, what stands in the pile at the start
  double short_for = 0.0;     ///< how long the head has not sufficed [s]
  bool stopped = false;       ///< the head does not suffice
  bool pauses = false;        ///< nothing is to be placed now
  double still_for = 0.0;     ///< how long the concrete has been below its yield stress in a pause [s]
  std::vector<double> wall_mean = {};  ///< pressure on the wall of late, by cell [Pa]
  std::vector<double> wall_max;        ///< the largest of it so far
  double mouth_mean = 0.0;             ///< pressure at the mouth of late [Pa]

  /// The foot stands far below the mouth, and steps leave it out. Nothing of it is in `body`, `load` and `batched`.
  Foot<2> foot{};
  std::vector<double> foot_load = {}, foot_batched = {};
  double foot_level = 0.0;   ///< mean level up to which its pressure is known [m]
  int resting = 0;           ///< layers of cells that have been at rest below the mouth for ...
  double resting_for = 0.0;  ///< ... so long [s]
};

/// In a pause the concrete stands after so long below its yield stress [s]: until then its pressure settles.
inline constexpr double settles = 5.0;

/// Whether nothing of it moves until the next load is placed.
template <class Section>
bool stands(const Pour<Section>& pour) {
  return pour.still_for >= settles;
}

/// Points of a cage from the base up to `height` [m] on cells of this height [m].
std::vector<BarPoint<2>> screen_of(const Cage& cage, double height, double cell);

/// The pile filled to just above the pipe's mouth.
template <class Section>
Pour<Section> start_of(const Scene& scene);

template <class Section>
double mouth_of(const Pour<Section>& pour) {
  const Axis& up = pour.body.grid.axes[1];
  return up.origin + pour.inlet.face * up.h;
}
/// How far the pipe reaches from the middle on the grid [m].
template <class Section>
double pipe_radius(const Pour<Section>& pour) {
  return pour.inlet.cells * pour.body.grid.axes[0].h;
}
/// Area of the bore beside the pipe [m^2].
template <class Section>
double section_of(const Scene& scene, const Pour<Section>& pour) {
  const double R = scene.radius, r = pipe_radius(pour);
  return scene.width > 0.0 ? area_within(scene, R - r) : std::numbers::pi * (R * R - r * r);
}
/// Volume that came in and holds no points yet [m^3].
template <class Section>
double waiting(const Scene& scene, const Pour<Section>& pour) {
  return whole(scene) * volume_waiting(pour.inlet);
}
/// Mean level beside the pipe that the placed volume makes [m].
template <class Section>
double mean_level(const Scene& scene, const Pour<Section>& pour) {
  return (pour.placed - area_within(scene, pipe_radius(pour)) * mouth_of(pour)) / section_of(scene, pour);
}
/// Pressure of the displaced fluid [Pa].
inline double fluid_pressure(const Scene& scene, double height) {
  return scene.fluid_density * gravity * (scene.depth - height);
}

/// The load of the next volume, from 0.
std::size_t load_at(const Scene& scene, double volume);
/// lambda of the concrete that leaves the pipe.
template <class Section>
double flocculation_at_mouth(const Scene& scene, const Pour<Section>& pour);

/// Sets the flow for the step to come and returns how long it may be [s]. Pulls the pipe where it is due.
template <class Section>
double prepare(const Scene& scene, double cfl, Pour<Section>& pour);
/// What came in over the last step.
template <class Section>
void let_in(const Scene& scene, Pour<Section>& pour);

/// After a step: the foot waits beside it, and what has come to rest far below the mouth joins it.
template <class Section>
void keep_foot(const Scene& scene, const StepReport& step, Pour<Section>& pour);
/// Takes the foot back into the body, for what is read at the end.
template <class Section>
void take_foot_back(Pour<Section>& pour);

/// Pressures of a column of cells without what alternates from one to the next; a straight line stays as it is. With one
/// pressure a cell, alternating pressures push quadratic splines nowhere (docs/theory/bored_pile.md).
std::vector<double> without_stripes(const std::vector<double>& of_cells);

/// Readings of the concrete as it stands.
template <class Section>
Sample read(const Scene& scene, const StepReport& step, Pour<Section>& pour);
template <class Section>
void read_results(const Scene& scene, const Pour<Section>& pour, const std::vector<Sample>& series,
                  Results& results);

}  // namespace tremie::bored_pile
