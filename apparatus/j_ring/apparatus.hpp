#pragma once

#include "apparatus/common/apparatus.hpp"

namespace tremie::j_ring {

/// The J-ring test of EN 12350-12, for the registry: a slump flow through a ring of bars.
scene::Apparatus apparatus();

}  // namespace tremie::j_ring
