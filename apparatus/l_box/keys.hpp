#pragma once

#include "apparatus/l_box/l_box.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"

namespace tremie::scene {

/// The keys of `apparatus = "l_box"`.
ApparatusKeys l_box_keys();

/// The checked values as a scene; throws InputError where they do not fit each other.
l_box::Scene l_box_scene(const Values& values);

}  // namespace tremie::scene
