#pragma once

#include "apparatus/common/outcome.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::scene {

/// The keys of `apparatus = "slump_flow"`.
ApparatusKeys slump_flow_keys();

/// Checked values as the apparatus' own scene. Throws InputError where several values contradict each other.
slump_flow::Scene slump_flow_scene(const Values& values);

/// Runs the slump-flow test and names its numbers. Without `all_frames` the observer sees the last frame
/// alone.
Outcome run_slump_flow(const slump_flow::Scene& scene, const Measured& measured, bool all_frames,
                       const Observer& observer);

/// What this scene carries and what it leaves out, a line each.
std::vector<std::string> slump_flow_uses(const slump_flow::Scene& scene);

}  // namespace tremie::scene
