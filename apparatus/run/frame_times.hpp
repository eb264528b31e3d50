#pragma once

#include <algorithm>

namespace tremie::experiment {

/// When the frame after that of time t is due [s]. An interval of 0 is chosen: a fifth of a second at first, a
/// fourth of the time that has gone by later, since a flow slows down as it spreads.
inline double frame_after(double t, double interval) {
  return interval > 0.0 ? t + interval : std::max(t + 0.2, 1.25 * t);
}

}  // namespace tremie::experiment
