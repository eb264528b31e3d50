#include <gtest/gtest.h>

#include "apparatus/run/machine/free_processors.hpp"
#include "apparatus/run/machine/team.hpp"
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

/// A run of so many seconds, made up: in stretches of a hundredth of a second's work, where `pace(threads)` is the clock of
/// such a stretch over that of one thread; put off so many times a second. Its clock [s] and how much of it fewer threads than
/// all had.
struct MadeUp {
  double clock = 0.0, fewer = 0.0;
};
template <class Pace>
MadeUp made_up(Team& team, int all, double seconds, double put_off, Pace pace) {
  MadeUp run;
  int threads = team.after(0.0, 0.0, 0.0);
  for (double work = 0.0; work < seconds; work += 0.01) {
    const double clock = 0.01 * pace(threads);
    run.clock += clock, run.fewer += threads < all ? clock : 0.0;
    threads = team.after(0.01, clock, put_off * clock);
  }
  return run;
}

// On an idle machine threads are put off now and then, and all are kept.
TEST(Team, KeepsAllThreadsThatAreNotPutOff) {
  Team team(2);
  const MadeUp run = made_up(team, 2, 100.0, 5.0, [](int n) { return n == 2 ? 0.6 : 1.0; });
  EXPECT_EQ(run.fewer, 0.0);
}

// Two threads that take four times the clock of one are given back: what the trials take, half a second of ten, costs less
// than a third. When the others have gone, both are taken again.
TEST(Team, GivesThreadsBackAndTakesThemAgain) {
  Team team(2);
  const MadeUp busy = made_up(team, 2, 100.0, 200.0, [](int n) { return n == 2 ? 4.0 : 1.0; });
  EXPECT_LT(busy.clock, 1.3 * 100.0);
  const MadeUp idle = made_up(team, 2, 100.0, 1.0, [](int n) { return n == 2 ? 0.6 : 1.0; });
  EXPECT_LT(idle.clock, 75.0);
}

// Threads that are put off and yet faster together stay: a trial of fewer costs little.
TEST(Team, KeepsWhatIsFaster) {
  Team team(2);
  const MadeUp run = made_up(team, 2, 100.0, 200.0, [](int n) { return n == 2 ? 0.8 : 1.0; });
  EXPECT_LT(run.clock, 84.0);
}

// Of many threads as many are given back as others need: of eight the fastest four here.
TEST(Team, FindsTheNumberBetween) {
  Team team(8);
  const auto pace = [](int n) { return n == 8 ? 1.5 : n == 4 ? 0.3 : 1.0 / n; };
  EXPECT_LT(made_up(team, 8, 200.0, 200.0, pace).clock, 1.15 * 0.3 * 200.0);
}

}  // namespace tremie::experiment
