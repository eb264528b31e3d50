#include "apparatus/verification/suite.hpp"

#include <array>

namespace tremie::verification {

std::span<const Step> ladder() {
  static constexpr std::array<Step, 12> steps{{
      {1, "law", "stress of every yield law, in rotated frames", law_cases},
      {2, "flocculation", "lambda against closed forms and CVODE", flocculation_cases},
      {3, "rest", "bodies at rest and in rigid motion", rest_cases},
      {4, "film", "film down a plane, plane Poiseuille flow", film_cases},
      {5, "couette", "Couette flow, thixotropic as well", couette_cases},
      {6, "spreading", "spreading on a floor", spreading_cases},
      {7, "l_box", "the L-box at rest", l_box_cases},
      {8, "paper", "what the paper prints", paper_cases},
      {9, "closed_loop", "parameters, virtual vane, torque, fit, parameters", closed_loop_cases},
      {10, "extremes", "stiff and extreme scenes, judged by physics", extremes_cases},
      {11, "error_bars", "whether the error bars of --with-error hold", error_bars_cases},
      {12, "pareto", "which scheme for which CPU budget", pareto_cases},
  }};
  return steps;
}

}  // namespace tremie::verification
