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

Singles random_singles(std::mt19937& random, double size) {
  return to_single(random_lanes(random, -size, size), random_lanes(random, -size, size));
}

/// What the first n points add in double precision; `one`: what point l gives.
template <class One>
TileGrid<D>::Buffer expected_sums(const SixteenPoints& points, std::size_t n, TileRows& rows, One one) {
  TileGrid<D>::Buffer sums{};
  rows = 0;
  for (std::size_t l = 0; l < n; ++l) {
    NodeLanes value = {}, slope[D] = {}, moment[D] = {};
    one(l, value, slope, moment);
    scatter<D, 3>(&sums[static_cast<std::size_t>(points.base(l))], points.one(l), value, slope, moment);
    rows |= stencil_rows<D>(points.base(l));
  }
  return sums;
}

constexpr std::size_t numbers_of_points[] = {16, 11, 1};

/// All controls but the ones behind the rows of stencils, which are added nothing that counts.
void expect_sums(const TileGrid<D>::SingleBuffer& got, const TileGrid<D>::Buffer& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i)
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(static_cast<double>(got[i][c]), expected[i][c], 16.0 * rounding) << i << ' ' << c;
}

TEST_P(SingleSums, MomentaAsDoubleHasThem) {
  const SixteenPoints points(GetParam().kind, GetParam().low, GetParam().high);
  std::mt19937 random(4);
  SingleMomenta<D> momenta;
  for (Singles& value : momenta.value) value = random_singles(random, 1.0);
  for (auto& moment : momenta.moment)
    for (Singles& component : moment) component = random_singles(random, 1.0 / h);
  // In double precision moments are about the point.
  const auto one = [&](std::size_t l, NodeLanes& value, NodeLanes*, NodeLanes* moment) {
    for (int c = 0; c < 4; ++c) value[c] = static_cast<double>(momenta.value[c][l]);
    for (int d = 0; d < D; ++d)
      for (int c = 0; c < D; ++c) {
        moment[d][c] = static_cast<double>(momenta.moment[d][c][l]);
        value[c] -= moment[d][c] * static_cast<double>(points.single.middle[d][l]);
      }
  };
  for (const std::size_t n : numbers_of_points) {
    TileRows rows;
    const auto expected = expected_sums(points, n, rows, one);
    TileGrid<D>::SingleBuffer got{};
    const Reached reached = scatter_momenta<D>(points.single, momenta, n, got.data());
    EXPECT_EQ(reached.rows, rows);
    EXPECT_GE(reached.runs, 1);
    expect_sums(got, expected);
  }
}

TEST_P(SingleSums, ImpulsesAsDoubleHasThem) {
  const SixteenPoints points(GetParam().kind, GetParam().low, GetParam().high);
  std::mt19937 random(5);
  SingleImpulses<D> impulses;
  for (Singles& value : impulses.value) value = random_singles(random, 1.0);
  for (auto& slope : impulses.slope)
    for (Singles& component : slope) component = random_singles(random, h);
  for (const bool values : {false, true}) {
    const auto one = [&](std::size_t l, NodeLanes& value, NodeLanes* slope, NodeLanes*) {
      for (int c = 0; c < D && values; ++c) value[c] = static_cast<double>(impulses.value[c][l]);
      for (int d = 0; d < D; ++d)
        for (int c = 0; c < D; ++c) slope[d][c] = static_cast<double>(impulses.slope[d][c][l]);
    };
    for (const std::size_t n : numbers_of_points) {
      TileRows rows;
      const auto expected = expected_sums(points, n, rows, one);
      TileGrid<D>::SingleBuffer got{};
      const Reached reached = values ? scatter_impulses<D, true>(points.single, impulses, n, got.data())
                                     : scatter_impulses<D, false>(points.single, impulses, n, got.data());
      EXPECT_EQ(reached.rows, rows);
      EXPECT_GE(reached.runs, 1);
      expect_sums(got, expected);
    }
  }
}

// Stresses move no momentum but from one control to another: of a run of points with one stencil to what the
// sums are rounded by, each in units of the largest of them.
TEST(SingleSums, ImpulsesOfStressesAddUpToNothing) {
  const SixteenPoints points(ShapeFunctions::gimp, 0.21, 0.24);
  std::mt19937 random(6);
  SingleImpulses<D> impulses;
  for (auto& slope : impulses.slope)
    for (Singles& component : slope) component = random_singles(random, h);
  TileGrid<D>::SingleBuffer sums{};
  scatter_impulses<D, false>(points.single, impulses, singles_size, sums.data());
  NodeLanes total = {};
  double largest = 0.0;
  for (const SingleNode& node : sums) {
    total += in_double(node);
    for (int c = 0; c < D; ++c) largest = std::max(largest, std::abs(static_cast<double>(node[c])));
  }
  EXPECT_GT(largest, 0.1);
  for (int c = 0; c < D; ++c) EXPECT_NEAR(total[c], 0.0, 27 * 1.2e-7 * largest);
}

}  // namespace
}  // namespace tremie
