// More than 100 kills at random moments, half of them while a file is being written: no byte is lost. Every scheme,
// geometry and apparatus, then explicit steps by precision, transfer and order, on one thread and on two.

#include <gtest/gtest.h>

#include <iostream>

#include "tests/apparatus/killed_runs.hpp"

namespace tremie {
namespace {

void kill_all(const std::vector<test::KilledScene>& scenes, int kills, unsigned seed) {
  test::KilledRuns runs(seed);
  for (const test::KilledScene& scene : scenes) runs.kill(scene, kills);
  for (const auto& [moment, n] : runs.moments()) std::cout << n << " killed while " << moment << '\n';
  EXPECT_EQ(runs.killed(), kills * static_cast<int>(scenes.size()));
}

TEST(Resume, EveryApparatusKilled) { kill_all(test::killed_scenes, 8, 2); }
TEST(Resume, EveryExplicitStepKilled) { kill_all(test::killed_explicit_scenes, 4, 3); }

}  // namespace
}  // namespace tremie
