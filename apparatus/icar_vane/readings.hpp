#pragma once

// What the instrument would report from the torques, with the tools of the rheometer.

#include <optional>

#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::icar_vane {

/// lambda that equation (6) gives for a torque at a speed [rev/s], with the torque that the same mix without
/// flocculation takes as the offset; empty without thixotropy or at rest.
std::optional<double> apparent_flocculation(const Scene& scene, double torque, double speed);

/// Fills the results from the series.
void read_instrument(const Scene& scene, Outcome& outcome);

/// Torques on the blades, on the wall (with the rate of angular momentum) and from the power must agree at
/// the end; a reason where they do not.
void check_torques_agree(Outcome& outcome);

}  // namespace tremie::icar_vane
