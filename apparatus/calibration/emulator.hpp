#pragma once

// A Gaussian process through runs (OpenTURNS): a reading over the unknowns, in microseconds.

#include <memory>
#include <vector>

namespace tremie::calibration {

using Point = std::vector<double>;  ///< shares of the unknowns' ranges, 0 to 1

struct Prediction {
  double mean = 0.0, variance = 0.0;
};

struct Emulator {
  struct State;
  std::shared_ptr<const State> state;
  /// Of each run: what the process through the others predicts there, less what the run gave.
  std::vector<double> left_out;
};

/// At least dimensions + 3 points. `logarithmic`: works on the logarithm of the values, which are above 0.
/// Throws std::invalid_argument where there are too few.
Emulator train(const std::vector<Point>& points, const std::vector<double>& values, bool logarithmic);

std::vector<Prediction> predict(const Emulator& emulator, const std::vector<Point>& points);

}  // namespace tremie::calibration
