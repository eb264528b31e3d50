#pragma once

#include "apparatus/common/apparatus.hpp"

namespace tremie::icar_vane {

/// The apparatus for the registry.
scene::Apparatus apparatus();

}  // namespace tremie::icar_vane
