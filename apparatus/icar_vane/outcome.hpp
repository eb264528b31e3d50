#pragma once

#include "apparatus/common/outcome.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::scene {

/// Runs the vane test and names its numbers. Without `all_frames` the observer sees the last frame alone.
Outcome run_icar_vane(const icar_vane::Scene& scene, const Measured& measured, bool all_frames,
                      const Observer& observer);

/// What this scene carries and what it leaves out, a line each.
std::vector<std::string> icar_vane_uses(const icar_vane::Scene& scene);

}  // namespace tremie::scene
