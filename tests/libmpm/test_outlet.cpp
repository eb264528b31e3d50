// An outlet takes points out of a run and counts them.

#include <gtest/gtest.h>

#include "libmpm/boundary/openings/outlet.hpp"

namespace tremie {
namespace {

/// Points at the heights 0, 1, ... with masses 1, 2, ... and all that a thixotropic one carries.
Points<2> column(int n) {
  Points<2> points;
  points.lambda_parts.resize(2);
  for (int i = 0; i < n; ++i) {
    add_point<2>(points, {0.0, i}, 1.0 + i, 1e-3, 0.01 * i);
    points.v.back() = {0.0, 10.0 + i};
    points.lambda.push_back(20.0 + i), points.gamma_dot.push_back(30.0 + i);
    points.lambda_parts[0].push_back(40.0 + i), points.lambda_parts[1].push_back(50.0 + i);
  }
  return points;
}

// Below the height 1.5 are the points 0 and 1: what they held is counted, and the others keep their order and their values.
TEST(Outlet, TakesWhatIsBeyondItAndCountsIt) {
  Points<2> points = column(5);
  const double volume = points.volume(0) + points.volume(1);
  Outflow left;
  let_out<2>({{0.0, -1.0}, -1.5}, points, left);
  EXPECT_EQ(left.points, 2);
  EXPECT_EQ(left.mass, 3.0);
  EXPECT_EQ(left.volume, volume);
  ASSERT_EQ(points.size(), 3U);
  for (std::size_t p = 0; p < 3; ++p) {
    const double i = static_cast<double>(p) + 2.0;
    EXPECT_EQ(points.x[p][1], i);
    EXPECT_EQ(points.v[p][1], 10.0 + i);
    EXPECT_EQ(points.mass[p], 1.0 + i);
    EXPECT_EQ(points.ln_J[p], 0.01 * i);
    EXPECT_EQ(points.lambda[p], 20.0 + i);
    EXPECT_EQ(points.gamma_dot[p], 30.0 + i);
    EXPECT_EQ(points.lambda_parts[0][p], 40.0 + i);
    EXPECT_EQ(points.lambda_parts[1][p], 50.0 + i);
  }
  EXPECT_EQ(points.C.size(), 3U);
  EXPECT_EQ(points.V0.size(), 3U);
}

// What a mix without thixotropy does not have stays empty; an outlet that nothing has reached leaves all as it is.
TEST(Outlet, LeavesWhatHasNotReachedIt) {
  Points<2> points = column(3);
  points.lambda.clear(), points.gamma_dot.clear(), points.lambda_parts.clear();
  Outflow left;
  let_out<2>({{0.0, -1.0}, 0.5}, points, left);
  EXPECT_EQ(left.points, 0);
  EXPECT_EQ(points.size(), 3U);
  let_out<2>({{0.0, 1.0}, 1.5}, points, left);
  EXPECT_EQ(points.size(), 2U);
  EXPECT_TRUE(points.lambda.empty());
}

}  // namespace
}  // namespace tremie
