#include "apparatus/verification/suite.hpp"

#include <array>

namespace tremie::verification {

std::span<const Entry> suite() {
  static constexpr std::array<Entry, 12> entries{{
      {1, "law", "stress of every yield law, in rotated frames", law_case, 0.05},
      {2, "flocculation", "lambda against closed forms and CVODE", flocculation_case, 0.1},
      {3, "rest", "bodies at rest and in rigid motion", rest_case, 0.5},
      {4, "film", "film down a plane, plane Poiseuille flow", film_case, 5.9},
      {5, "couette", "Couette flow, thixotropic as well", couette_case, 9.6},
      {6, "spreading", "spreading on a floor", spreading_case, 25},
      {7, "l_box", "the L-box at rest", l_box_case, 41.5},
      {8, "paper", "what the paper prints", paper_case, 4.2},
      {9, "closed_loop", "parameters, virtual vane, torque, fit, parameters", closed_loop_case, 0.2},
      {10, "extremes", "stiff and extreme scenes, judged by physics", extremes_case, 6.9},
      {11, "error_bars", "whether the error bars of --with-error hold", error_bars_case, 13.2},
      {12, "pareto", "which scheme for which CPU budget", pareto_case, 46.3},
  }};
  return entries;
}

}  // namespace tremie::verification
