// Student's distribution against printed tables (three decimals), medians by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "rheometer/regression/statistics.hpp"

namespace tremie {
namespace {

TEST(Statistics, StudentQuantilesMatchTheTables) {
  EXPECT_NEAR(student_quantile(0.975, 1), 12.706, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 2), 4.303, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 5), 2.571, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 30), 2.042, 5e-4);
  EXPECT_NEAR(student_quantile(0.975, 1e6), 1.960, 5e-4);
  EXPECT_NEAR(student_quantile(0.9995, 5), 6.869, 5e-4);
  EXPECT_NEAR(student_quantile(0.025, 5), -2.571, 5e-4);
  EXPECT_EQ(student_quantile(0.5, 7), 0.0);
}

// One degree of freedom is Cauchy's distribution: P = 1/2 + atan(t)/pi.
TEST(Statistics, StudentQuantileHasCauchysClosedForm) {
  for (const double t : {-30.0, -1.0, 0.0, 0.5, 100.0})
    EXPECT_NEAR(student_quantile(0.5 + std::atan(t) / std::acos(-1.0), 1), t, 1e-11 * (1.0 + t * t)) << t;
}

TEST(Statistics, MedianAndRobustDeviation) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_EQ(median({}), 0.0);
  EXPECT_NEAR(robust_deviation({-1.0, 1.0, -2.0, 2.0, 1000.0}), 1.4826 * 2.0, 1e-12);
}

TEST(Statistics, SuccessiveCorrelation) {
  EXPECT_NEAR(successive_correlation({1.0, -1.0, 1.0, -1.0}), -0.75, 1e-15);
  EXPECT_NEAR(successive_correlation({1.0, 1.0, 1.0, 1.0}), 0.75, 1e-15);
  EXPECT_EQ(successive_correlation({}), 0.0);
}

}  // namespace
}  // namespace tremie
