// Threads that stay together from pass to pass, and work that they share.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <numeric>
#include <thread>

#include "libmpm/parallel/thread_pool.hpp"

namespace tremie {
namespace {

// In each of many rounds every member is called once, and what all of them wrote is there when run() returns:
// each adds the round's number to its own sum, which is no atomic.
TEST(ThreadPool, EveryMemberOnceARound) {
  for (const int n : {1, 2, 5}) {
    ThreadPool pool(n);
    EXPECT_EQ(pool.size(), n);
    std::vector<long> sum(static_cast<std::size_t>(n), 0);
    for (long round = 1; round <= 2000; ++round) {
      pool.run([&](int s) { sum[static_cast<std::size_t>(s)] += round; });
      ASSERT_EQ(std::accumulate(sum.begin(), sum.end(), 0L), n * round * (round + 1) / 2);
    }
  }
}

// A member that has looked in vain for long enough sleeps, and is woken by the next round; so is the caller
// by the last of the others.
TEST(ThreadPool, WakesWhoSleeps) {
  ThreadPool pool(3);
  for (int round = 0; round < 3; ++round) {
    std::atomic<int> calls = 0;
    pool.run([&](int s) {
      if (s > 0) std::this_thread::sleep_for(std::chrono::milliseconds(30));
      ++calls;
    });
    EXPECT_EQ(calls, 3);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
}

// A pool that never had a round lets its threads go.
TEST(ThreadPool, GoesWithoutARound) { ThreadPool pool(4); }

// One thread sleeps at its first piece: the other does all that is left, and none is done twice.
TEST(WorkSharing, OthersDoWhatIsLeft) {
  WorkSharing work;
  work.set_out({0, 50, 60});
  ThreadPool pool(2);
  for (int slow = 0; slow < 2; ++slow) {
    work.start_anew();
    std::array<std::atomic<int>, 60> visits{};
    std::array<int, 2> done{};
    std::atomic<bool> slow_has_begun = false, other_is_done = false;
    pool.run([&](int s) {
      while (s != slow && !slow_has_begun) std::this_thread::yield();
      work.take(s, [&](int piece) {
        ++visits[static_cast<std::size_t>(piece)];
        ++done[static_cast<std::size_t>(s)];
        slow_has_begun = true;
        while (s == slow && !other_is_done) std::this_thread::yield();
      });
      other_is_done = true;
    });
    for (const auto& visit : visits) EXPECT_EQ(visit, 1);
    EXPECT_EQ(done[static_cast<std::size_t>(slow)], 1);
    EXPECT_EQ(done[static_cast<std::size_t>(1 - slow)], 59);
  }
}

// Runs are done towards each other: 0 1 2 and 6 5 4 3.
TEST(WorkSharing, EverySecondRunGoesFromItsEnd) {
  WorkSharing work;
  work.set_out({0, 3, 7});
  std::vector<int> pieces;
  work.take(0, [&](int piece) { pieces.push_back(piece); });
  EXPECT_EQ(pieces, (std::vector<int>{0, 1, 2, 6, 5, 4, 3}));
  pieces.clear();
  work.start_anew();
  work.take(1, [&](int piece) { pieces.push_back(piece); });
  EXPECT_EQ(pieces, (std::vector<int>{6, 5, 4, 3, 0, 1, 2}));
}

// Who waits sees what was written before the mark, also when it has gone to sleep over it.
TEST(EpochFlags, AreWaitedFor) {
  EpochFlags marks;
  marks.set_out(2);
  int written = 0, seen = 0;
  ThreadPool pool(2);
  pool.run([&](int s) {
    if (s == 0) {
      marks.wait_for(1, 3);
      seen = written;
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      marks.mark(1, 2);
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      written = 7;
      marks.mark(1, 3);
    }
  });
  EXPECT_EQ(seen, 7);
  marks.wait_for(1, 1);  // long done
}

}  // namespace
}  // namespace tremie
