#pragma once

#include "apparatus/parts/cone/cone_test.hpp"

namespace tremie::verification {

/// A quantity of the curve at a time [s], linear between the steps; the last one after the flow has stopped.
inline double at(const cone::Outcome& outcome, double time, double cone::Sample::*quantity) {
  const auto& series = outcome.series;
  for (std::size_t i = 1; i < series.size(); ++i)
    if (series[i].time >= time) {
      const double share = (time - series[i - 1].time) / (series[i].time - series[i - 1].time);
      return series[i - 1].*quantity + share * (series[i].*quantity - series[i - 1].*quantity);
    }
  return series.back().*quantity;
}

/// The spread at a time [mm].
inline double spread_at(const cone::Outcome& outcome, double time) {
  return 1e3 * at(outcome, time, &cone::Sample::spread);
}

}  // namespace tremie::verification
