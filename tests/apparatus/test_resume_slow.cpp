// 100 kills at random moments over every scheme, geometry and apparatus: no byte is lost.

#include <gtest/gtest.h>

#include "tests/apparatus/killed_runs.hpp"

namespace tremie {
namespace {

TEST(Resume, HundredKills) {
  test::KilledRuns runs(2);
  int killed = 0;
  for (unsigned round = 0; killed < 100 && round < 60; ++round)
    killed += runs.compare(test::killed_scenes[round % test::killed_scenes.size()], 6);
  EXPECT_GE(killed, 100);
}

}  // namespace
}  // namespace tremie
