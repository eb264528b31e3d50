// The spread and the height that are read off points whose outline is known.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "apparatus/parts/cone/spread.hpp"

namespace tremie::cone {
namespace {

/// Points in rows `s` apart, turned by `angle`, that fill an ellipse of half axes a and b in one layer.
Points<3> ellipse(double a, double b, double s, double angle = 0.0) {
  Points<3> points;
  const int n = static_cast<int>(std::ceil(std::max(a, b) * 1.5 / s));
  for (int i = -n; i < n; ++i)
    for (int j = -n; j < n; ++j) {
      const double u = (i + 0.5) * s, v = (j + 0.5) * s;
      const double x = u * std::cos(angle) - v * std::sin(angle),
                   y = u * std::sin(angle) + v * std::cos(angle);
      if (x * x / (a * a) + y * y / (b * b) < 1.0) add_point<3>(points, {x, y, 0.5 * s}, 1.0, s * s * s, 0.0);
    }
  return points;
}

// Cauchy: the mean width of a convex outline is its perimeter over pi. An outline of rows 2 mm apart is
// within one of them of the ellipse's on either side.
TEST(SlumpFlowReading, AnEllipseHasItsMeanWidth) {
  const double a = 0.3, b = 0.24, s = 2e-3;
  const double k = (a - b) * (a - b) / ((a + b) * (a + b));  // perimeter after Ramanujan, to 1e-9
  const double perimeter = std::numbers::pi * (a + b) * (1.0 + 3.0 * k / (10.0 + std::sqrt(4.0 - 3.0 * k)));
  EXPECT_NEAR(spread(ellipse(a, b, s), 2 * s, false), perimeter / std::numbers::pi, 2 * s);
}

// A disc of points 7.5 mm apart, as on cells of 15 mm, however its rows lie: 16 directions would find 603.4
// to 605.4 mm, 64 find it within a fifth of a millimetre of the mean over all.
TEST(SlumpFlowReading, RowsOfPointsMayLieAsTheyWill) {
  for (int k = 0; k < 9; ++k)
    EXPECT_NEAR(spread(ellipse(0.3, 0.3, 7.5e-3, k * std::numbers::pi / 18.0), 0.015, false), 0.60454, 2e-4);
}

TEST(SlumpFlowReading, AQuarterReadsAsItsWhole) {
  const Points<3> whole = ellipse(0.3, 0.27, 7.5e-3);
  Points<3> quarter;
  for (const Vec<3>& x : whole.x)
    if (x[0] > 0.0 && x[1] > 0.0) add_point<3>(quarter, x, 1.0, std::pow(7.5e-3, 3), 0.0);
  EXPECT_NEAR(spread(quarter, 0.015, true), spread(whole, 0.015, false), 1e-12);
}

// Three points that are far from all others, and from each other, are none of the outline, but in the few
// directions in which they stand level with it: by less than half a cell there, so that the mean of all moves
// by a millimetre at most. Of a section they are none at all.
TEST(SlumpFlowReading, StraysDoNotCount) {
  for (const double away : {0.32, 0.4, 2.0}) {
    Points<3> points = ellipse(0.3, 0.3, 7.5e-3);
    const double without = spread(points, 0.015, false);
    for (const Vec<3>& x : {Vec<3>(away, 0.0, 0.0), Vec<3>(0.0, 1.1 * away, 0.0), Vec<3>(-away, -away, 0.0)})
      add_point<3>(points, x, 1.0, std::pow(7.5e-3, 3), 0.0);
    EXPECT_NEAR(spread(points, 0.015, false), without, 1e-3);
  }
  Points<2> section;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 4; ++j) add_point<2>(section, {(i + 0.5) * 5e-3, (j + 0.5) * 5e-3}, 1.0, 1e-9, 0.0);
  const double without = spread(section, 0.01);
  EXPECT_NEAR(without, 0.4, 5e-3);
  add_point<2>(section, {0.9, 0.0}, 1.0, 1e-9, 0.0);
  EXPECT_DOUBLE_EQ(spread(section, 0.01), without);
}

// Of nothing but strays the outermost counts.
TEST(SlumpFlowReading, OnlyStrays) {
  Points<3> points;
  add_point<3>(points, {0.1, 0.0, 0.0}, 1.0, 1e-9, 0.0);
  add_point<3>(points, {0.0, 0.3, 0.0}, 1.0, 1e-9, 0.0);
  EXPECT_DOUBLE_EQ(spread(points, 0.01, false), 0.6);
  Points<2> ring;
  add_point<2>(ring, {0.2, 0.0}, 1.0, 1e-9, 0.0);
  EXPECT_DOUBLE_EQ(spread(ring, 0.01), 0.4);
}

}  // namespace
}  // namespace tremie::cone
