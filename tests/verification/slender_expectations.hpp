#pragma once

#include <gtest/gtest.h>

#include "apparatus/verification/references/slender.hpp"

namespace tremie::verification {

// 3 % at every time from 3 to 120 s, against the equation from the same state and against the published
// diameters.
inline void expect_slender_flow_follows_the_lubrication_equation(double across, double up) {
  const SlenderFlow flow = slender_flow(across, up);
  EXPECT_EQ(flow.unconverged, 0);
  EXPECT_NEAR(flow.layer_volume / cone_volume(), 1.0, 5e-3);
  for (const SlenderSample& s : flow.samples) {
    std::printf(
        "slender, %g x %g mm, %3d s: %.1f mm, lubrication from 2 s %.1f (%+.2f %%), published %d (%+.2f "
        "%%)\n",
        1e3 * across, 1e3 * up, s.time, 1e3 * s.spread, 1e3 * s.lubrication,
        100 * (s.spread / s.lubrication - 1), s.published, 100 * (1e3 * s.spread / s.published - 1));
    EXPECT_NEAR(s.spread / s.lubrication, 1.0, 0.03);
    EXPECT_NEAR(1e3 * s.spread / s.published, 1.0, 0.03);
  }
}

}  // namespace tremie::verification
