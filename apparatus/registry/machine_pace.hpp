#pragma once

// How fast this machine is at what a scene does, by a blink of it.

#include "apparatus/registry/registry.hpp"

namespace tremie::scene {

/// How many times as long as on the machine of the rates (cost_estimate.hpp) a step takes here, with the program as it is
/// compiled: from the first steps of a small slump flow by the scene's scheme and in as many directions, a tenth of a second.
double machine_pace(const Scene& scene);

}  // namespace tremie::scene
