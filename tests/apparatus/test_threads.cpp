#include <gtest/gtest.h>

#include "apparatus/run/threads.hpp"

namespace tremie::test_run {
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
}  // namespace tremie::test_run
