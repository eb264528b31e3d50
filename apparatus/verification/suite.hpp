#pragma once

// The verification ladder: every rung that the library can climb, as `tremie verify` runs it.

#include <span>

#include "apparatus/verification/case.hpp"

namespace tremie::verification {

CaseGroup law_cases(Depth depth);           ///< 1: stress against closed forms, in rotated frames
CaseGroup flocculation_cases(Depth depth);  ///< 2: lambda against closed forms and CVODE
CaseGroup rest_cases(Depth depth);          ///< 3: bodies at rest and in rigid motion
CaseGroup film_cases(Depth depth);          ///< 4: film and plane Poiseuille flow
CaseGroup couette_cases(Depth depth);       ///< 5: Couette flow, thixotropic as well
CaseGroup spreading_cases(Depth depth);     ///< 6: spreading on a floor
CaseGroup l_box_cases(Depth depth);         ///< 7: the L-box at rest
CaseGroup paper_cases(Depth depth);         ///< 8: what the paper prints; no bounds
CaseGroup closed_loop_cases(Depth depth);   ///< 9: parameters -> vane -> torque -> fit -> parameters
CaseGroup extremes_cases(Depth depth);      ///< 10: stiff and extreme scenes
CaseGroup error_bars_cases(Depth depth);    ///< 11: whether the error bars hold
CaseGroup pareto_cases(Depth depth);        ///< 12: which scheme for which CPU budget

struct Step {
  int number;
  const char* name;  ///< as on the command line
  const char* what;
  CaseGroup (*run)(Depth);
};

/// All of them, in order.
std::span<const Step> ladder();

}  // namespace tremie::verification
