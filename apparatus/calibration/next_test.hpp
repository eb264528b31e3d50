#pragma once

// Which further test would narrow the answer most.

#include <string>
#include <vector>

#include "apparatus/calibration/calibrate.hpp"

namespace tremie::calibration {

/// A test that could be made next.
struct Advice {
  std::string test;          ///< "slump flow after 240 s"
  std::string result, unit;  ///< what would be read
  double value = 0.0;        ///< its mean over the posterior
  double scatter = 0.0;      ///< its standard deviation over the posterior: what the test has to tell
  double error = 0.0;        ///< assumed of the measurement, one standard error
  double bits = 0.0;         ///< expected information about the unknowns
  /// By parameter: the standard deviation that is expected to be left, over the one there is.
  std::vector<double> left;
};

/// Candidates (slump flow after 0, 60, 240 and 600 s, t500, L-box, vane after 60 and 240 s) run at points drawn from the
/// posterior, the most telling first. The expected information is that of Gaussians, log2(1 + scatter^2/error^2)/2; the
/// parameters narrow by their correlation with the reading. Tests that the known keys do not allow are left out. Empty
/// where interrupted.
std::vector<Advice> advise(const Lab& lab, const Calibration& calibration, const Settings& settings);

}  // namespace tremie::calibration
