#pragma once

// The verification suite: every case, as `tremie verify` runs it.

#include <span>

#include "apparatus/verification/case.hpp"

namespace tremie::verification {

Case law_case(Depth depth);           ///< 1: stress against closed forms, in rotated frames
Case flocculation_case(Depth depth);  ///< 2: lambda against closed forms and CVODE
Case rest_case(Depth depth);          ///< 3: bodies at rest and in rigid motion
Case film_case(Depth depth);          ///< 4: film and plane Poiseuille flow
Case couette_case(Depth depth);       ///< 5: Couette flow, thixotropic as well
Case spreading_case(Depth depth);     ///< 6: spreading on a floor
Case l_box_case(Depth depth);         ///< 7: the L-box at rest
Case paper_case(Depth depth);         ///< 8: what the paper prints; no bounds
Case closed_loop_case(Depth depth);   ///< 9: parameters -> vane -> torque -> fit -> parameters
Case extremes_case(Depth depth);      ///< 10: stiff and extreme scenes
Case error_bars_case(Depth depth);    ///< 11: whether the error bars hold
Case pareto_case(Depth depth);        ///< 12: which scheme for which CPU budget

struct Entry {
  int number;
  const char* name;  ///< as on the command line
  const char* what;
  Case (*run)(Depth);
};

/// All of them, in order.
std::span<const Entry> suite();

}  // namespace tremie::verification
