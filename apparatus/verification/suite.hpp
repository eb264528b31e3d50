#pragma once

// The verification suite: every case, as `tremie verify` runs it.

#include <span>

#include "apparatus/verification/case.hpp"

namespace tremie::verification {

Case law_case(Depth depth), flocculation_case(Depth depth), rest_case(Depth depth), film_case(Depth depth),
    couette_case(Depth depth), spreading_case(Depth depth), l_box_case(Depth depth), paper_case(Depth depth),
    closed_loop_case(Depth depth), extremes_case(Depth depth), error_bars_case(Depth depth),
    pareto_case(Depth depth);

struct Entry {
  int number;
  const char* name;  ///< as on the command line
  const char* what;
  Case (*run)(Depth);
  double quick_cpu;  ///< of Depth::quick on the machine of the rates (registry/cost_estimate.hpp) [s]
};

/// All of them, in order.
std::span<const Entry> suite();

}  // namespace tremie::verification
