#pragma once

// The slump-flow test of EN 12350-8: an Abrams cone of concrete, lifted off a floor, and the spread that it leaves.

#include "apparatus/common/apparatus.hpp"

namespace tremie::slump_flow {

/// The keys of `apparatus = "slump_flow"`.
scene::ApparatusKeys keys();

/// The apparatus for the registry.
scene::Apparatus apparatus();

}  // namespace tremie::slump_flow
