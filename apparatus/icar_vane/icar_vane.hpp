#pragma once

// The ICAR vane rheometer: a vane turning in a container of concrete, the torque that it takes, and what the
// instrument would report from that torque beside what was put in.

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/apparatus.hpp"
#include "apparatus/common/model.hpp"
#include "apparatus/run/record.hpp"
#include "libmpm/boundary/wall_law.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::icar_vane {

/// The instrument [m]; the defaults are the ICAR's. In the spaces couette and plane the ends above and below the vane
/// are neglected: every torque is that of a section times the vane's height. The cylindrical space has them (ends.hpp).
struct Vane {
  double radius = 0.0635;
  double height = 0.127;
  double container_radius = 0.143;
  int blades = 4;                  ///< plane sections alone; a Couette section is a solid cylinder
  double blade_thickness = 0.003;  ///< plane and cylindrical [m]
  double shaft_radius = 0.01;      ///< about which the blades stand; plane and cylindrical [m]
  double bottom_gap = 0.0795;      ///< below the blades, cylindrical alone [m]
  double cover = 0.0795;           ///< concrete above the blades, cylindrical alone [m]
};

/// A checked scene, SI units; speeds in revolutions a second.
struct Scene {
  Mix mix;
  Vane vane;
  double rest = 0.0;           ///< before the vane turns [s]
  double duration = 20.0;      ///< at constant speed [s]
  double speed = 0.25;         ///< [rev/s], at constant speed; negative turns the other way
  std::vector<double> speeds;  ///< a flow curve's speeds [rev/s]; empty: constant speed
  double pre_shear_speed = 0.5, pre_shear_time = 20.0;  ///< before a flow curve [rev/s], [s]
  double hold_time = 5.0;                               ///< of each speed of a flow curve [s]
  double average_time = 2.0;     ///< the last part of each hold, over which the torque is averaged [s]
  WallLaw walls;                 ///< along the container, or the cylinder: no_slip or interface
  bool cylinder_slides = false;  ///< the law holds along the cylinder, the container holds; couette alone
  double orientation = 0.0;      ///< of the blades against the points, plane sections alone [rad]
  Model model;                   ///< space couette, plane or cylindrical
  double frame_interval = 0.0;   ///< [s]
  int threads = 1;
  bool with_reference = true;  ///< read torque_couette_reference; no scene key, for runs that are coarser
};

inline FaceKind container_face(const Scene& scene) {
  return scene.cylinder_slides ? FaceKind::no_slip : face(scene.walls);
}
inline FaceKind cylinder_face(const Scene& scene) {
  return scene.cylinder_slides ? face(scene.walls) : FaceKind::no_slip;
}
inline bool slides(const Scene& scene) { return wall_stress(scene.walls).has_value(); }

inline constexpr double start_up_time = 0.1;  ///< in which the vane reaches a new speed, evenly [s]
inline constexpr double first_dt = 1e-3;      ///< the first step after a change of speed [s]

/// Share of a change of speed that the vane has made in the step that begins so long after it [s].
inline double start_up(double time) { return std::clamp((time + first_dt) / start_up_time, 0.0, 1.0); }

/// One line of timeseries.csv. Torques [N m] about the axis, of the vane's whole height.
struct Sample {
  double time = 0.0;             ///< since the vane began to turn [s]
  double speed = 0.0;            ///< [rev/s]
  double torque = 0.0;           ///< on the blades
  double torque_wall = 0.0;      ///< on the container
  double torque_power = 0.0;     ///< dissipated power over Omega
  double momentum_rate = 0.0;    ///< rate of angular momentum: torque - torque_wall in a transient
  double shear_rate_mean = 0.0;  ///< volume mean [1/s]
  std::optional<double> flocculation_mean = {}, flocculation_apparent = {};  ///< equation (6) for the second
  double time_step = 0.0;                                                    ///< [s]
  int iterations = 0;
  double slip = 0.0;  ///< mean speed of the concrete along the wall that slides [m/s]
};

/// Reiner-Riwlin's parameters from a flow curve.
struct ReinerRiwlin {
  double yield_stress = 0.0;       ///< [Pa]
  double plastic_viscosity = 0.0;  ///< [Pa s]
};

struct CurvePoint {
  double speed = 0.0, torque = 0.0;  ///< [rev/s], [N m]
};

/// At one radius, mean over the angle.
struct ProfilePoint {
  double radius = 0.0, velocity = 0.0, shear_rate = 0.0;  ///< [m], [m/s], [1/s]
  std::optional<double> flocculation = {};
};

struct Results {
  double torque_peak = 0.0, torque_end = 0.0, torque_wall_end = 0.0, torque_power_end = 0.0;  ///< [N m]
  double inertia_at_peak = 0.0;                    ///< rate of the angular momentum there [N m]
  double slip_end = 0.0;                           ///< [m/s]
  std::optional<ReinerRiwlin> reiner_riwlin = {};  ///< from a flow curve, as the instrument would report it
  /// Equation (6) at the peak and at the end of a constant speed [Pa]. A flow curve tells nothing of the
  /// static one, and its dynamic one is Reiner-Riwlin's.
  std::optional<double> static_yield_stress_apparent = {}, dynamic_yield_stress_apparent = {};
  std::optional<double> flocculation_apparent_start = {}, alpha_apparent = {};
  double shear_rate_nominal =
      0.0;                    ///< 2 Omega / (1 - R_i^2/R_o^2), which alpha_apparent was divided by [1/s]
  double alpha_window = 0.0;  ///< over which alpha_apparent was fitted [s]
  std::optional<double> torque_couette_reference = {};  ///< of the solid cylinder at the end [N m]
  /// Cylindrical alone: the torque at the end over that of the plane section times the height.
  std::optional<double> end_factor = {}, torque_plane = {};  ///< the second [N m]
  std::vector<CurvePoint> flow_curve;
  std::vector<ProfilePoint> profile;  ///< at the end
};

using Outcome = experiment::Record<Results, Sample>;

/// Runs the test; as cone::run.
Outcome run(const Scene& scene, const scene::Observer& observer = {});

scene::SizeEstimate estimate(const Scene& scene);

/// A speed held for a time.
struct Stage {
  double speed = 0.0, duration = 0.0;  ///< [rev/s], [s]
};

inline std::vector<Stage> stages_of(const Scene& scene) {
  if (scene.speeds.empty()) return {{scene.speed, scene.duration}};
  std::vector<Stage> stages = {{scene.pre_shear_speed, scene.pre_shear_time}};
  for (double speed : scene.speeds) stages.push_back({speed, scene.hold_time});
  return stages;
}

/// Whole time of the schedule [s].
double whole_time(const Scene& scene);

/// The keys of `apparatus = "icar_vane"`, and the checked values as a scene; throws InputError where several contradict each
/// other.
scene::ApparatusKeys keys();
Scene read_scene(const scene::Values& values);

/// The apparatus for the registry.
scene::Apparatus apparatus();

}  // namespace tremie::icar_vane
