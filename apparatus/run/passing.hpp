#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace tremie::experiment {

/// When a reading of the series first passed a value on its way up, between two lines by a straight line [s]; empty where it
/// never did. Sample has a `time` [s].
template <class Sample>
std::optional<double> time_of_passing(const std::vector<Sample>& series, double Sample::*reading,
                                      double value) {
  for (std::size_t i = 1; i < series.size(); ++i) {
    const Sample &a = series[i - 1], &b = series[i];
    if (b.*reading < value) continue;
    const double share = (value - a.*reading) / (b.*reading - a.*reading);
    return a.time + std::clamp(share, 0.0, 1.0) * (b.time - a.time);
  }
  return std::nullopt;
}

}  // namespace tremie::experiment
