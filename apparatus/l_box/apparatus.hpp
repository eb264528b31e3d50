#pragma once

#include "apparatus/common/apparatus.hpp"

namespace tremie::l_box {

/// The apparatus for the registry.
scene::Apparatus apparatus();

}  // namespace tremie::l_box
