#pragma once

#include "apparatus/common/outcome.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::scene {

/// Runs the slump-flow test and names its numbers. Without `all_frames` the observer sees the last frame
/// alone.
Outcome run_slump_flow(const slump_flow::Scene& scene, const Measured& measured, bool all_frames,
                       const Observer& observer);

/// What this scene carries and what it leaves out, a line each.
std::vector<std::string> slump_flow_uses(const slump_flow::Scene& scene);

}  // namespace tremie::scene
