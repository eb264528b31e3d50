#pragma once

// What the instrument would report from the torques, with the tools of the rheometer.

#include <optional>
#include <string>

#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::icar_vane {

/// lambda that equation (6) gives for a torque at a speed [rev/s], with the torque that the same mix without
/// flocculation takes as the offset; empty without thixotropy or at rest.
std::optional<double> apparent_flocculation(const Scene& scene, double torque, double speed);

/// "torque 0.512 N.m": while a run goes on.
std::string progress_text(const Sample& sample);

/// Fills the results from the series.
void read_instrument(const Scene& scene, Outcome& outcome);

/// Torques on the blades, on the wall (with the rate of angular momentum) and from the power must agree at
/// the end; a reason where they do not.
void check_torques_agree(const Scene& scene, Outcome& outcome);

/// Adds a reason where a Couette section's torque at the end is not that of the radial equations, which its
/// own three readings cannot tell when all of them follow one wrong stress.
void check_against_reference(const Scene& scene, Outcome& outcome);

}  // namespace tremie::icar_vane
