#pragma once

#include <string>

#include "apparatus/estimate/estimate.hpp"

namespace tremie::estimate {

/// What `tremie estimate --json` prints: results and checks.reasons; null where the table does not reach.
std::string estimate_json(const MixEstimate& estimate);

}  // namespace tremie::estimate
