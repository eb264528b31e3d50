#pragma once

// A concentric-cylinder rheometer, and the shear rates that are quoted for it.

#include <numbers>

#include "rheometer/records/torque_record.hpp"

namespace tremie {

/// Vane (as the cylinder that it sweeps) in a container; the ICAR rheometer's by default. No end effects.
struct Instrument {
  double vane_radius = 0.0635;      ///< R_i [m]
  double vane_height = 0.127;       ///< h [m]
  double container_radius = 0.143;  ///< R_o [m]
};

/// Angular speed [rad/s] of n [rev/s].
inline double angular_speed(double revolutions_per_second) {
  return 2.0 * std::numbers::pi * revolutions_per_second;
}

/// A gap so narrow that its shear is even, of which the torque [N m] is the shear stress [Pa] and the speed [rad/s] the
/// shear rate [1/s] times evenly_sheared_speed: exact for a Bingham material, within 1e-5 for any.
inline Instrument evenly_sheared() {
  const double outer = 1.0 + evenly_sheared_gap;
  const double height = (1.0 - 1.0 / (outer * outer)) / (4.0 * std::numbers::pi * evenly_sheared_speed);
  return {1.0, height, outer};
}
inline bool is_evenly_sheared(const Instrument& instrument) {
  return instrument.vane_radius == 1.0 && instrument.container_radius == 1.0 + evenly_sheared_gap;
}

/// Shear stress [Pa] on the cylinder of radius r [m] that carries the torque T [N m], equation (6).
inline double shear_stress_at(double radius, double torque, const Instrument& instrument) {
  return torque / (2.0 * std::numbers::pi * radius * radius * instrument.vane_height);
}

/// The shear rate at the vane that a Newtonian fluid would have, 2 Omega / (1 - R_i^2/R_o^2) [1/s].
/// Nominal: a yield-stress fluid in the same gap is sheared faster, in a narrower layer.
inline double newtonian_shear_rate(double omega, const Instrument& instrument) {
  const double ratio = instrument.vane_radius / instrument.container_radius;
  return 2.0 * omega / (1.0 - ratio * ratio);
}

/// Throws std::invalid_argument unless 0 < R_i < R_o and h > 0, all finite.
void check(const Instrument& instrument);

}  // namespace tremie
