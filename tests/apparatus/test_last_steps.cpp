#include <gtest/gtest.h>

#include <cmath>

#include "apparatus/run/step_settings.hpp"

namespace tremie::experiment {
namespace {

TEST(LastSteps, TwoHalvesInPlaceOfASliver) {
  EXPECT_EQ(without_sliver(0.15, 0.1), 0.075);
  EXPECT_EQ(without_sliver(0.05, 0.1), 0.05);
  EXPECT_EQ(without_sliver(0.5, 0.1), 0.5);
}

// The second half leaves what it takes, but for the rounding of the clock; one more bit must not make it two steps, or
// compilers and processors end the same scene by different steps.
TEST(LastSteps, RoundingDoesNotHalveTheSecondHalf) {
  const double left = 0.0151612780266067, more = std::nextafter(left, 1.0);
  EXPECT_EQ(without_sliver(left, left), left);
  EXPECT_EQ(without_sliver(more, left), more);
}

}  // namespace
}  // namespace tremie::experiment
