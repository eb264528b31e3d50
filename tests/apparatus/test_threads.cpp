#include <gtest/gtest.h>

#include "apparatus/run/machine/free_processors.hpp"
#include "apparatus/run/machine/threads.hpp"

namespace tremie::experiment {
namespace {

TEST(Threads, ASectionTakesOneWhateverItsSize) {
  for (const SpaceKind space :
       {SpaceKind::axisymmetric, SpaceKind::plane, SpaceKind::plane_with_side_walls, SpaceKind::couette})
    EXPECT_EQ(default_threads(1000000, space, SchemeKind::implicit, 8), 1);
}

TEST(Threads, AFullBodyTakesASecondAndAQuarterDoesNot) {
  EXPECT_EQ(default_threads(3250, SpaceKind::quarter, SchemeKind::implicit, 2), 1);
  EXPECT_EQ(default_threads(9999, SpaceKind::full, SchemeKind::implicit, 2), 1);
  EXPECT_EQ(default_threads(13000, SpaceKind::full, SchemeKind::implicit, 2), 2);
  EXPECT_EQ(default_threads(13000, SpaceKind::full, SchemeKind::implicit, 16), 2);
}

// The published preset's quarter has 3,249 points.
TEST(Threads, AQuarterByExplicitStepsTakesASecond) {
  for (const SchemeKind scheme : {SchemeKind::explicit_usl, SchemeKind::explicit_usf}) {
    EXPECT_EQ(default_threads(3249, SpaceKind::quarter, scheme, 2), 2);
    EXPECT_EQ(default_threads(3249, SpaceKind::quarter, scheme, 1), 1);
    EXPECT_EQ(default_threads(3000, SpaceKind::quarter, scheme, 2), 1);
    EXPECT_EQ(default_threads(3249, SpaceKind::axisymmetric, scheme, 2), 1);
  }
}

TEST(Threads, NeverMoreThanTheMachineHas) {
  EXPECT_EQ(default_threads(1000000, SpaceKind::half, SchemeKind::implicit, 2), 2);
  EXPECT_EQ(default_threads(1000000, SpaceKind::half, SchemeKind::implicit, 1), 1);
  EXPECT_EQ(default_threads(1000000, SpaceKind::half, SchemeKind::implicit, 0), 1);
}

}  // namespace
// Processors that others use are not taken: /proc/loadavg has the mean over a minute, then what runs now, the asking
// process included; cpu.max the quota and its period in microseconds.
TEST(Threads, FollowWhatIsFree) {
  EXPECT_EQ(free_processors(8, "0.05 0.10 0.20 1/200 4242", "max 100000"), 8);
  EXPECT_EQ(free_processors(8, "3.20 1.00 0.20 4/200 4242", "max 100000"), 5);
  EXPECT_EQ(free_processors(8, "3.20 1.00 0.20 1/200 4242", "max 100000"), 8);  // it has just ended
  EXPECT_EQ(free_processors(2, "27.7 20.0 9.00 29/900 4242", "max 100000"), 1);
  EXPECT_EQ(free_processors(8, "0.00 0.00 0.00 1/200 4242", "250000 100000"), 3);
  EXPECT_EQ(free_processors(4, "", ""), 4);
}

}  // namespace tremie::experiment
