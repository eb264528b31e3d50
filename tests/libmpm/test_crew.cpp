// Threads that stay together from pass to pass.

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>

#include "libmpm/grid/crew.hpp"

namespace tremie {
namespace {

// In each of many rounds every member is called once, and what all of them wrote is there when run() returns:
// each adds the round's number to its own sum, which is no atomic.
TEST(Crew, EveryMemberOnceARound) {
  for (const int n : {1, 2, 5}) {
    Crew crew(n);
    EXPECT_EQ(crew.size(), n);
    std::vector<long> sum(static_cast<std::size_t>(n), 0);
    for (long round = 1; round <= 2000; ++round) {
      crew.run([&](int s) { sum[static_cast<std::size_t>(s)] += round; });
      ASSERT_EQ(std::accumulate(sum.begin(), sum.end(), 0L), n * round * (round + 1) / 2);
    }
  }
}

// A member that has looked in vain for long enough sleeps, and is woken by the next round; so is the caller
// by the last of the others.
TEST(Crew, WakesWhoSleeps) {
  Crew crew(3);
  for (int round = 0; round < 3; ++round) {
    std::atomic<int> calls = 0;
    crew.run([&](int s) {
      if (s > 0) std::this_thread::sleep_for(std::chrono::milliseconds(30));
      ++calls;
    });
    EXPECT_EQ(calls, 3);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
}

// A crew that never had a round lets its threads go.
TEST(Crew, GoesWithoutARound) { Crew crew(4); }

}  // namespace
}  // namespace tremie
