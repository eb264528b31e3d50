#pragma once

#include "apparatus/common/outcome.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/l_box/l_box.hpp"

namespace tremie::scene {

/// Runs the L-box test and names its numbers. Without `all_frames` the observer sees the last frame alone.
Outcome run_l_box(const l_box::Scene& scene, const Measured& measured, bool all_frames,
                  const Observer& observer);

/// What this scene carries and what it leaves out, a line each.
std::vector<std::string> l_box_uses(const l_box::Scene& scene);

}  // namespace tremie::scene
