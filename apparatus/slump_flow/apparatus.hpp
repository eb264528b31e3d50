#pragma once

#include "apparatus/common/apparatus.hpp"

namespace tremie::slump_flow {

/// The apparatus for the registry.
scene::Apparatus apparatus();

}  // namespace tremie::slump_flow
