// A build without OpenTURNS has no calibration.

#include "apparatus/validation/validation.hpp"

namespace tremie::validation {

bool has_calibration() { return false; }

Section alpha_of_pairs(const Settings&) { return {}; }

}  // namespace tremie::validation
