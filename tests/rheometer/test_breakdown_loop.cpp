// A closed loop over 12 made records of each case of breakdown_coverage.hpp, of which the slow test has 200. Ten of twelve
// intervals at least must hold the truth: honest ones fail this in 2 % of samples, and these seeds are fixed; intervals half
// as wide (67 %) pass it in 15 %. A record tells a to 0.003 to 0.010, so the median of twelve is known to 0.001 to 0.004.

#include <gtest/gtest.h>

#include "tests/rheometer/breakdown_coverage.hpp"

namespace tremie::made {
namespace {

TEST(BreakdownLoop, RateAndExponentOfMadeRecordsAreFound) {
  constexpr int seeds = 12;
  for (const Case& c : cases()) {
    const Covered covered = coverage_of(c, seeds);
    EXPECT_EQ(covered.missing, 0) << c.name;
    EXPECT_GE(covered.k, 10) << c.name;
    EXPECT_GE(covered.a, 10) << c.name;
    EXPECT_NEAR(covered.median(), c.material.a, 0.01) << c.name;
  }
}

}  // namespace
}  // namespace tremie::made
