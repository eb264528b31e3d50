// Sums between points and grid in single precision against those in double: the same sums but for rounding.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "libmpm/transfer/single_sums.hpp"

namespace tremie {
namespace {

constexpr int D = 3;
constexpr double h = 0.1;
/// A dozen roundings of numbers up to one; places in a tile are rounded too, to 2^-22 of a cell.
constexpr double rounding = 3e-6;

Octet random_lanes(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> u(low, high);
  Octet x;
  for (int l = 0; l < octet_size; ++l) x[l] = u(random);
  return x;
}

/// Sixteen points in cells next to a wall and away from it, with their weights in both precisions and what a
/// tile's controls carry.
struct SixteenPoints {
  Weights<D> weights[2];
  SingleWeights<D> single;
  TileGrid<D>::Buffer v;
  TileGrid<D>::SingleBuffer single_v;

  /// `n`: points beyond it stand where the first of their eight does.
  SixteenPoints(ShapeFunctions kind, double low, double high, std::size_t n = singles_size) {
    std::array<Axis, D> axes;
    for (Axis& a : axes) a = {.h = h, .low = FaceKind::no_slip};
    Shape<D> shape{kind, {}};
    shape.half.fill(0.25);
    std::mt19937 random(3);
    std::array<Octet, D> x[2];
    const auto frame = stencil_frame<D>(axes, shape, {0, 0, 0});
    for (int half = 0; half < 2; ++half) {
      for (Octet& lanes : x[half]) {
        lanes = random_lanes(random, low, high);
        for (std::size_t l = 0; l < octet_size; ++l)
          if (static_cast<std::size_t>(half) * octet_size + l >= n) lanes[l] = lanes[0];
      }
      weigh<D>(axes, shape, {0, 0, 0}, x[half], weights[half]);
    }
    weigh_single<D, slopes_and_moments>(frame, x, single);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    single_v.fill(SingleNode{});
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] = NodeLanes{u(random), u(random), u(random), u(random)};
      single_v[i] = __builtin_convertvector(v[i], SingleNode);
    }
  }

  const Weights<D>& of(std::size_t l) const { return weights[l / octet_size]; }
  int base(std::size_t l) const { return of(l).base[l % octet_size]; }
  PointWeights<D, 3> one(std::size_t l) const { return of_lane<D>(of(l), static_cast<int>(l % octet_size)); }
};

struct Case {
  ShapeFunctions kind;
  double low, high;  ///< where the points are [m]
};

class SingleSums : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cells, SingleSums,
                         testing::Values(Case{ShapeFunctions::b_spline, 0.21, 0.29},
                                         Case{ShapeFunctions::b_spline, 0.0, 0.4},
                                         Case{ShapeFunctions::gimp, 0.21, 0.24},
                                         Case{ShapeFunctions::gimp, 0.001, 0.4}));

// A smooth field is read the same wherever a rounding puts a point's stencil; these controls are random, so
// that points which the two put into different stencils, at most one in a million, must not be among them.
TEST_P(SingleSums, StencilsBeginAlike) {
  const SixteenPoints points(GetParam().kind, GetParam().low, GetParam().high);
  for (std::size_t l = 0; l < singles_size; ++l) EXPECT_EQ(points.single.base[l], points.base(l));
}

TEST_P(SingleSums, GatherAsDoubleDoes) {
  const SixteenPoints points(GetParam().kind, GetParam().low, GetParam().high);
  for (const std::size_t n : {std::size_t{16}, std::size_t{11}, std::size_t{1}}) {
    SingleFields<D> slopes, moments;
    gather_slopes<D, true>(points.single_v.data(), points.single, n, slopes);
    gather_moments<D>(points.single_v.data(), points.single, n, moments);
    for (std::size_t l = 0; l < n; ++l) {
      const auto read = gather<D, 3, slopes_and_moments>(&points.v[static_cast<std::size_t>(points.base(l))],
                                                         points.one(l));
      for (int c = 0; c < D; ++c) {
        EXPECT_NEAR(static_cast<double>(slopes.value[c][l]), read.value[c], rounding);
        EXPECT_EQ(moments.value[c][l], slopes.value[c][l]);
        for (int d = 0; d < D; ++d) {
          EXPECT_NEAR(static_cast<double>(slopes.along[d][c][l]), read.slope[d][c], rounding / h);
          EXPECT_NEAR(static_cast<double>(moments.along[d][c][l]), read.moment[d][c], rounding * h);
        }
      }
    }
    for (std::size_t l = n; l < singles_size; ++l) EXPECT_TRUE(std::isfinite(moments.along[0][0][l]));
  }
}

// What fills up eight points moves with the first of them, to the bit.
TEST_P(SingleSums, WhatFillsUpReadsAsItsFirst) {
  for (const std::size_t n : {std::size_t{3}, std::size_t{11}}) {
    const SixteenPoints points(GetParam().kind, GetParam().low, GetParam().high, n);
    SingleFields<D> moments;
    gather_moments<D>(points.single_v.data(), points.single, n, moments);
    const std::size_t first = (n - 1) / octet_size * octet_size;
    for (std::size_t l = n; l < first + octet_size; ++l)
      for (int c = 0; c < D; ++c) {
        EXPECT_EQ(moments.value[c][l], moments.value[c][first]);
        for (int d = 0; d < D; ++d) EXPECT_EQ(moments.along[d][c][l], moments.along[d][c][first]);
      }
  }
}

TEST_P(SingleSums, InertiaAsDoubleHasIt) {
  const SixteenPoints points(GetParam().kind, GetParam().low, GetParam().high);
  for (int d = 0; d < D; ++d)
    for (std::size_t l = 0; l < singles_size; ++l)
      EXPECT_NEAR(static_cast<double>(points.single.inertia[d][l]),
                  points.of(l).inertia[static_cast<std::size_t>(d)][l % octet_size], rounding * h * h);
}

/// What the first n points add in double precision; `spread` gives moments about the middle control.
TileGrid<D>::Buffer expected_sums(const SixteenPoints& points, const SingleSpread<D>& spread, std::size_t n,
                                  TileRows& rows) {
  TileGrid<D>::Buffer sums{};
  rows = 0;
  for (std::size_t l = 0; l < n; ++l) {
    NodeLanes value = {}, slope[D] = {}, moment[D] = {};
    for (int c = 0; c < 4; ++c) value[c] = static_cast<double>(spread.value[c][l]);
    for (int d = 0; d < D; ++d)
      for (int c = 0; c < D; ++c) {
        slope[d][c] = static_cast<double>(spread.slope[d][c][l]);
        moment[d][c] = static_cast<double>(spread.moment[d][c][l]);
        value[c] -= moment[d][c] * static_cast<double>(points.single.middle[d][l]);
      }
    scatter<D, 3>(&sums[static_cast<std::size_t>(points.base(l))], points.one(l), value, slope, moment);
    rows |= stencil_rows<D>(points.base(l));
  }
  return sums;
}

TEST_P(SingleSums, ScatterAsDoubleDoes) {
  const SixteenPoints points(GetParam().kind, GetParam().low, GetParam().high);
  std::mt19937 random(4);
  const auto lanes = [&](double size) {
    return to_single(random_lanes(random, -size, size), random_lanes(random, -size, size));
  };
  SingleSpread<D> spread;
  for (Singles& value : spread.value) value = lanes(1.0);
  for (int d = 0; d < D; ++d)
    for (int c = 0; c < D; ++c) spread.slope[d][c] = lanes(h), spread.moment[d][c] = lanes(1.0 / h);
  for (const std::size_t n : {std::size_t{16}, std::size_t{11}, std::size_t{1}}) {
    TileRows rows;
    const auto expected = expected_sums(points, spread, n, rows);
    TileGrid<D>::SingleBuffer got{};
    const Reached reached = scatter_single<D, Given{}>(points.single, spread, n, got.data());
    EXPECT_EQ(reached.rows, rows);
    EXPECT_GE(reached.runs, 1);
    for (std::size_t i = 0; i < expected.size(); ++i)
      for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(static_cast<double>(got[i][c]), expected[i][c], 16.0 * rounding);
  }
}

// What a pass without motion and one without stress give is what both give, in two parts.
TEST(SingleSums, PartsAddUp) {
  const SixteenPoints points(ShapeFunctions::gimp, 0.0, 0.4);
  std::mt19937 random(5);
  SingleSpread<D> spread;
  for (Singles& value : spread.value)
    value = to_single(random_lanes(random, 0, 1), random_lanes(random, 0, 1));
  for (int d = 0; d < D; ++d)
    for (int c = 0; c < D; ++c)
      spread.slope[d][c] = spread.moment[d][c] =
          to_single(random_lanes(random, -0.1, 0.1), random_lanes(random, -0.1, 0.1));
  TileGrid<D>::SingleBuffer both{}, parts{};
  scatter_single<D, Given{}>(points.single, spread, singles_size, both.data());
  scatter_single<D, Given{.values = false, .moments = false}>(points.single, spread, singles_size,
                                                              parts.data());
  scatter_single<D, Given{.slopes = false}>(points.single, spread, singles_size, parts.data());
  for (std::size_t i = 0; i < both.size(); ++i)
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(static_cast<double>(both[i][c]), static_cast<double>(parts[i][c]), 16.0 * rounding);
}

}  // namespace
}  // namespace tremie
