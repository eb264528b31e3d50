#pragma once

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"

namespace tremie::scene {

/// The keys of `apparatus = "icar_vane"`.
ApparatusKeys icar_vane_keys();

/// Checked values as the apparatus' own scene. Throws InputError where several values contradict each other.
icar_vane::Scene icar_vane_scene(const Values& values);

}  // namespace tremie::scene
