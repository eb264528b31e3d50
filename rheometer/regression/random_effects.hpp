#pragma once

// A straight line through values that come with a covariance and may scatter about it by more than that: the variance
// between them is the one with which the weighted squares are as large as their degrees of freedom (Paule and Mandel, J.
// Res. Natl. Bur. Stand. 87 (1982) 377), where Cochran's Q test finds one at 5 %; its intervals are then Student's with
// n - 2 degrees of freedom (Knapp and Hartung, Stat. Med. 22 (2003) 2693).

#include <vector>

namespace tremie {

struct LineOfEstimates {
  double intercept = 0.0, slope = 0.0;
  double half_of_intercept = 0.0, half_of_slope = 0.0;  ///< of the 95 % intervals
  double between = 0.0;  ///< standard deviation of the values about the line beyond their own
  double chance = 1.0;   ///< of so much scatter by their own errors alone
};

/// `covariance` row by row, of the y; `degrees` of freedom that it has. At least two different x.
LineOfEstimates line_of_estimates(const std::vector<double>& x, const std::vector<double>& y,
                                  const std::vector<double>& covariance, double degrees);

}  // namespace tremie
