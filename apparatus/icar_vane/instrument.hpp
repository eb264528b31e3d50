#pragma once

// What the instrument would report from the torques, with the tools of the rheometer.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::icar_vane {

/// lambda that equation (6) gives for a torque at a speed [rev/s], with the torque that the same mix without
/// flocculation takes as the offset; empty without thixotropy or at rest.
std::optional<double> apparent_flocculation(const Scene& scene, double torque, double speed);

/// "torque 0.512 N.m": while a run goes on.
std::string progress_text(const Sample& sample);

/// How wide the rested concrete is sheared at the vane when it starts at its slowest speed, by the law's Couette flow [m];
/// empty where it is nothing that breakdown narrows: without breakdown, by Roussel's power of the rate, a regularised law.
std::optional<double> sheared_width(const Scene& scene);

/// What `tremie check` says of it: where the torque decay depends on the grid.
std::vector<std::string> localisation_use(const Scene& scene);

/// Fills the results from the series, and adds the reasons why they are not to be trusted.
void read_and_check(const Scene& scene, Outcome& outcome);

}  // namespace tremie::icar_vane
