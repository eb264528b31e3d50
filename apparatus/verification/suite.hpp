#pragma once

// The verification ladder: every rung that the library can climb, as `tremie verify` runs it.

#include <span>

#include "apparatus/verification/case.hpp"

namespace tremie::verification {

Rung law_rung(Depth depth);           ///< 1: stress against closed forms, in rotated frames
Rung flocculation_rung(Depth depth);  ///< 2: lambda against closed forms and CVODE
Rung rest_rung(Depth depth);          ///< 3: bodies at rest and in rigid motion
Rung film_rung(Depth depth);          ///< 4: film and plane Poiseuille flow
Rung couette_rung(Depth depth);       ///< 5: Couette flow, thixotropic as well
Rung spreading_rung(Depth depth);     ///< 6: spreading on a floor
Rung l_box_rung(Depth depth);         ///< 7: the L-box at rest
Rung paper_rung(Depth depth);         ///< 8: what the paper prints; no bounds
Rung closed_loop_rung(Depth depth);   ///< 9: parameters -> vane -> torque -> fit -> parameters
Rung extremes_rung(Depth depth);      ///< 10: stiff and extreme scenes
Rung error_bars_rung(Depth depth);    ///< 11: whether the error bars hold
Rung pareto_rung(Depth depth);        ///< 12: which scheme for which CPU budget

struct Step {
  int number;
  const char* name;  ///< as on the command line
  const char* what;
  Rung (*run)(Depth);
};

/// All of them, in order.
std::span<const Step> ladder();

}  // namespace tremie::verification
