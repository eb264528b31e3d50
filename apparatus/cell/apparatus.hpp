#pragma once

#include "apparatus/common/apparatus.hpp"

namespace tremie::cell {

/// The apparatus for the registry. Its own command runs it.
scene::Apparatus apparatus();

}  // namespace tremie::cell
