#include <gtest/gtest.h>

#include "apparatus/run/threads.hpp"

namespace tremie::test_run {
namespace {

TEST(Threads, ASectionTakesOneWhateverItsSize) {
  for (const SpaceKind space :
       {SpaceKind::axisymmetric, SpaceKind::plane, SpaceKind::plane_with_side_walls, SpaceKind::couette})
    EXPECT_EQ(default_threads(1000000, space, 8), 1);
}

TEST(Threads, AFullBodyTakesASecondAndAQuarterDoesNot) {
  EXPECT_EQ(default_threads(3250, SpaceKind::quarter, 2), 1);
  EXPECT_EQ(default_threads(9999, SpaceKind::full, 2), 1);
  EXPECT_EQ(default_threads(13000, SpaceKind::full, 2), 2);
  EXPECT_EQ(default_threads(13000, SpaceKind::full, 16), 2);
}

TEST(Threads, NeverMoreThanTheMachineHas) {
  EXPECT_EQ(default_threads(1000000, SpaceKind::half, 2), 2);
  EXPECT_EQ(default_threads(1000000, SpaceKind::half, 1), 1);
  EXPECT_EQ(default_threads(1000000, SpaceKind::half, 0), 1);
}

}  // namespace
}  // namespace tremie::test_run
