// The 95 % intervals of k and a over 200 made records of each case (made_protocol.hpp: Runge-Kutta, 1 % noise, white or
// correlated): the truth must lie inside in 90 to 99 % of them. Binomial scatter at 95 % and 200 records is 1.5 %.

#include <gtest/gtest.h>

#include "tests/rheometer/breakdown_coverage.hpp"

namespace tremie::made {
namespace {

constexpr int seeds = 200;

TEST(BreakdownCoverage, IntervalsOfRateAndExponentAreHonest) {
  for (const Case& c : cases()) {
    const Covered covered = coverage_of(c, seeds);
    EXPECT_EQ(covered.missing, 0) << c.name;
    for (const int held : {covered.k, covered.a}) {
      EXPECT_GE(held, seeds * 90 / 100) << c.name;
      EXPECT_LE(held, seeds * 99 / 100) << c.name;
    }
    EXPECT_NEAR(covered.mean_a, c.material.a, 0.005) << c.name;  // a tenth of an interval
  }
}

}  // namespace
}  // namespace tremie::made
