// Rung 7: the L-box at rest.

#include "tests/verification/ladder/ladder.hpp"

namespace tremie::verification {

Rung l_box_rung(Depth) { return {7, "The L-box at rest", {}}; }

}  // namespace tremie::verification
