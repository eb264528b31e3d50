#include "rheometer/reference/references.hpp"

namespace tremie {

bool has_integrated_references() { return true; }

}  // namespace tremie
