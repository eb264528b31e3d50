// The mean of a field over a length of the material, against sums over all pairs of points.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "libmpm/particles/layer_mean.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie {
namespace {

template <int D>
std::vector<double> random_field(const Points<D>& points) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(0.0, 2.0);
  std::vector<double> field;
  for (std::size_t p = 0; p < points.size(); ++p) field.push_back(uniform(generator));
  return field;
}

/// One blade's sector of a vane, [20 mm, 60 mm] in radius, with a point or two in a cell.
ActiveGrid<2> sector_grid(Points<2>& points) {
  const double sector = 0.5 * std::acos(-1.0);
  ActiveGrid<2> grid;
  grid.axes[0] = {
      .h = 0.004, .origin = 0.02, .low = FaceKind::no_slip, .high = FaceKind::no_slip, .n_cells = 10};
  grid.axes[1] = {.h = sector / 16, .periodic = true, .n_cells = 16};
  seed_box<Polar>(
      {0.02, 0.0}, {0.06, sector}, {15, 24}, 2400.0, 1e6, [](const Vec<2>&) { return true; },
      [](const Vec<2>&) { return 0.0; }, points);
  activate(grid, points.x);
  return grid;
}

// All pairs, with the image of every point to either side of the sector: the same to rounding.
TEST(LayerMean, IsTheSumOverAllPairsInASectorThatRepeats) {
  Points<2> points;
  const ActiveGrid<2> grid = sector_grid(points);
  const std::vector<double> field = random_field(points);
  const double layer = 0.007, sector = grid.axes[1].length();
  const std::vector<double> means = detail::layer_means<Polar>(grid, points, field, layer);
  const auto cartesian = [](double r, double a) { return Vec<2>(r * std::cos(a), r * std::sin(a)); };
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec<2> x = cartesian(points.x[p][0], points.x[p][1]);
    double sum = 0.0, weights = 0.0;
    for (std::size_t q = 0; q < points.size(); ++q)
      for (const int image : {-1, 0, 1}) {
        const double far = (cartesian(points.x[q][0], points.x[q][1] + image * sector) - x).norm();
        const double weight = std::max(0.0, 1.0 - far / layer) * points.volume(q);
        sum += weight * field[q], weights += weight;
      }
    ASSERT_NEAR(means[p], sum / weights, 1e-12) << p;
  }
}

// A layer thinner than the points' spacing leaves every point its own value.
TEST(LayerMean, AThinLayerLeavesTheField) {
  Points<2> points;
  const ActiveGrid<2> grid = sector_grid(points);
  const std::vector<double> field = random_field(points);
  const std::vector<double> means = detail::layer_means<Polar>(grid, points, field, 1e-4);
  for (std::size_t p = 0; p < points.size(); ++p) EXPECT_DOUBLE_EQ(means[p], field[p]);
}

// On a line the mean beside a wall is one-sided: of a field that lies at the wall alone it is 2 h/layer times as large in a
// cell of h, as int (1 - x/layer) is layer/2; to first order of the points.
TEST(LayerMean, BesideAWallItIsOneSided) {
  Points<1> points;
  ActiveGrid<1> grid;
  const int n = 400;
  const double h = 1.0 / n, layer = 0.2;
  grid.axes[0] = {.h = h, .origin = 10.0, .low = FaceKind::no_slip, .high = FaceKind::no_slip, .n_cells = n};
  seed_box<Couette>(
      Vec<1>(10.0), Vec<1>(11.0), {n}, 2400.0, 1e6, [](const Vec<1>&) { return true; },
      [](const Vec<1>&) { return 0.0; }, points);
  activate(grid, points.x);
  std::vector<double> field(points.size(), 0.0);
  field[0] = 1.0;
  const std::vector<double> means = detail::layer_means<Couette>(grid, points, field, layer);
  EXPECT_NEAR(means[0] / (2.0 * h / layer), 1.0, 0.03);
  EXPECT_NEAR(means[40] / means[0], 0.25 / 0.875, 0.01);  // half the weight; norms of 1 - 1/8 and 1/2
  EXPECT_EQ(means[90], 0.0);
}

}  // namespace
}  // namespace tremie
