#pragma once

#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::scene {

/// The keys of `apparatus = "slump_flow"`.
ApparatusKeys slump_flow_keys();

/// Checked values as the apparatus' own scene. Throws InputError where several values contradict each other.
slump_flow::Scene slump_flow_scene(const Values& values);

}  // namespace tremie::scene
