// The 95 % intervals of k and a over 200 made records of each case (made_protocol.hpp: Runge-Kutta, 1 % noise, white or
// correlated): the truth must lie inside in 90 to 99 % of them. Binomial scatter at 95 % and 200 records is 1.5 %.
// The median of a must be the truth to three of its standard errors; a mean would move, since a is at least 0.
// TREMIE_COVERAGE_RECORDS=40 in the environment takes 40 of each; fewer than 200 are held to three times their scatter.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/rheometer/breakdown_coverage.hpp"

namespace tremie::made {
namespace {

int records() {
  const char* asked = std::getenv("TREMIE_COVERAGE_RECORDS");
  return asked ? std::max(1, std::atoi(asked)) : 200;
}

TEST(BreakdownCoverage, IntervalsOfRateAndExponentAreHonest) {
  const int n = records();
  const double least = n >= 200 ? 0.90 : 0.95 - 3.0 * std::sqrt(0.05 * 0.95 / n);
  const double most = n >= 200 ? 0.99 : 1.0;
  for (const Case& c : cases()) {
    const Covered covered = coverage_of(c, n);
    EXPECT_EQ(covered.missing, 0) << c.name;
    for (const int held : {covered.k, covered.a}) {
      EXPECT_GE(held, least * n) << c.name;
      EXPECT_LE(held, most * n) << c.name;
    }
    EXPECT_NEAR(covered.median(), c.material.a, 3.0 * covered.error_of_median()) << c.name;
  }
}

}  // namespace
}  // namespace tremie::made
