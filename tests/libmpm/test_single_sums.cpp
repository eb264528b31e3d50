// Sums between points and grid in single precision against those in double: the same sums but for rounding.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libmpm/transfer/single_sums.hpp"

namespace tremie {
namespace {

constexpr double h = 0.1;
/// A dozen roundings of numbers up to one; places in a tile are rounded too, to 2^-22 of a cell.
constexpr double rounding = 3e-6;
constexpr std::size_t numbers_of_points[] = {16, 11, 1};

f64x8 random_lanes(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> u(low, high);
  f64x8 x;
  for (int l = 0; l < f64x8_size; ++l) x[l] = u(random);
  return x;
}
f32x16 random_singles(std::mt19937& random, double size) {
  return to_single(random_lanes(random, -size, size), random_lanes(random, -size, size));
}

/// use(kind), with the shape functions known to the compiler.
template <class Use>
auto with_kind(ShapeFunctions kind, Use use) {
  using gimp = std::integral_constant<ShapeFunctions, ShapeFunctions::gimp>;
  using b_spline = std::integral_constant<ShapeFunctions, ShapeFunctions::b_spline>;
  return kind == ShapeFunctions::gimp ? use(gimp{}) : use(b_spline{});
}

/// Not a number wherever nothing is written.
template <int D>
SingleWeights<D> unwritten() {
  SingleWeights<D> weights;
  const f32x16 nan = std::numeric_limits<float>::quiet_NaN() - f32x16{};
  for (std::size_t i = 0; i < offsetof(SingleWeights<D>, base) / sizeof nan; ++i)
    std::memcpy(reinterpret_cast<char*>(&weights) + i * sizeof nan, &nan, sizeof nan);
  return weights;
}

struct Case {
  ShapeFunctions kind;
  double low, high;  ///< where the points are [m]
};

template <int D>
std::array<Axis, D> held_axes(double origin) {
  std::array<Axis, D> axes;
  for (Axis& a : axes) a = {.h = h, .origin = origin, .low = FaceKind::no_slip};
  return axes;
}
template <int D>
Shape<D> shape_of(ShapeFunctions kind) {
  Shape<D> shape{kind, {}};
  shape.half.fill(0.25);
  return shape;
}

/// Batch16 points in cells next to a wall and away from it, with their weights in both precisions and what a
/// tile's nodes carry. Weights that a pass does not ask for are not numbers.
template <int D>
struct SixteenPoints {
  Weights<D> weights[2];
  SingleWeights<D> with_slopes = unwritten<D>(), with_moments = unwritten<D>(), with_arms = unwritten<D>();
  ShapeFunctions kind;
  typename TileGrid<D>::Buffer v;
  typename TileGrid<D>::SingleBuffer single_v;

  /// `n`: points beyond it stand where the first of their eight does.
  explicit SixteenPoints(const Case& of, std::size_t n = f32x16_size) : kind(of.kind) {
    const auto axes = held_axes<D>(0.0);
    const auto shape = shape_of<D>(of.kind);
    std::mt19937 random(3);
    std::array<f64x8, D> x[2];
    for (int half = 0; half < 2; ++half) {
      for (f64x8& lanes : x[half]) {
        lanes = random_lanes(random, of.low, of.high);
        for (std::size_t l = 0; l < f64x8_size; ++l)
          if (static_cast<std::size_t>(half) * f64x8_size + l >= n) lanes[l] = lanes[0];
      }
      weigh<D>(axes, shape, {}, x[half], weights[half]);
    }
    const auto frame = stencil_frame<D>(axes, shape, {});
    with_kind(kind, [&](auto k) {
      weigh_single<k, WeighedFor::stress, D>(frame, x, with_slopes);
      weigh_single<k, WeighedFor::reading, D>(frame, x, with_moments);
      weigh_single<k, WeighedFor::giving, D>(frame, x, with_arms);
    });
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    single_v.fill(f32x4{});
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] = f64x4{u(random), u(random), u(random), u(random)};
      single_v[i] = __builtin_convertvector(v[i], f32x4);
    }
  }

  void read_moments(std::size_t n, SingleFields<D>& moments) const {
    with_kind(kind, [&](auto k) { gather_moments<k, D>(single_v.data(), with_moments, n, moments); });
  }
  Reached give(const SingleMomenta<D>& momenta, std::size_t n, f32x4* sums) const {
    return with_kind(kind, [&](auto k) { return scatter_momenta<k, D>(with_arms, momenta, n, sums); });
  }

  const Weights<D>& of(std::size_t l) const { return weights[l / f64x8_size]; }
  int base(std::size_t l) const { return of(l).base[l % f64x8_size]; }
  PointWeights<D, 3> one(std::size_t l) const { return of_lane<D>(of(l), static_cast<int>(l % f64x8_size)); }
};

// A smooth field is read the same wherever a rounding puts a point's stencil; these nodes are random, so
// that points which the two put into different stencils, at most one in a million, must not be among them.
template <int D>
void stencils_begin_alike(const Case& c) {
  const SixteenPoints<D> points(c);
  for (std::size_t l = 0; l < f32x16_size; ++l) {
    EXPECT_EQ(points.with_slopes.base[l], points.base(l));
    EXPECT_EQ(points.with_moments.base[l], points.base(l));
    EXPECT_EQ(points.with_arms.base[l], points.base(l));
  }
}

template <int D>
void gather_as_double_does(const Case& of) {
  const SixteenPoints<D> points(of);
  for (const std::size_t n : numbers_of_points) {
    SingleFields<D> slopes, moments, slopes_alone;
    gather_slopes<D, true>(points.single_v.data(), points.with_slopes, n, slopes);
    gather_slopes<D, false>(points.single_v.data(), points.with_slopes, n, slopes_alone);
    points.read_moments(n, moments);
    for (std::size_t l = 0; l < n; ++l) {
      const auto read = gather<D, 3, slopes_and_moments>(&points.v[static_cast<std::size_t>(points.base(l))],
                                                         points.one(l));
      for (int c = 0; c < D; ++c) {
        EXPECT_NEAR(static_cast<double>(slopes.value[c][l]), read.value[c], rounding);
        EXPECT_NEAR(static_cast<double>(moments.value[c][l]), read.value[c], rounding);
        for (int d = 0; d < D; ++d) {
          EXPECT_NEAR(static_cast<double>(slopes.along[d][c][l]), read.slope[d][c], rounding / h);
          EXPECT_EQ(slopes_alone.along[d][c][l], slopes.along[d][c][l]);
          EXPECT_NEAR(static_cast<double>(moments.along[d][c][l]), read.moment[d][c], rounding * h);
        }
      }
    }
    for (std::size_t l = n; l < f32x16_size; ++l) EXPECT_TRUE(std::isfinite(moments.along[0][0][l]));
  }
}

// What fills up eight points moves with the first of them, to the bit.
template <int D>
void what_fills_up_reads_as_its_first(const Case& of) {
  for (const std::size_t n : {std::size_t{3}, std::size_t{11}}) {
    const SixteenPoints<D> points(of, n);
    SingleFields<D> moments;
    points.read_moments(n, moments);
    const std::size_t first = (n - 1) / f64x8_size * f64x8_size;
    for (std::size_t l = n; l < first + f64x8_size; ++l)
      for (int c = 0; c < D; ++c) {
        EXPECT_EQ(moments.value[c][l], moments.value[c][first]);
        for (int d = 0; d < D; ++d) EXPECT_EQ(moments.along[d][c][l], moments.along[d][c][first]);
      }
  }
}

template <int D>
void inertia_as_double_has_it(const Case& of) {
  const SixteenPoints<D> points(of);
  for (int d = 0; d < D; ++d)
    for (std::size_t l = 0; l < f32x16_size; ++l)
      EXPECT_NEAR(static_cast<double>(points.with_moments.inertia[d][l]),
                  points.of(l).inertia[static_cast<std::size_t>(d)][l % f64x8_size], rounding * h * h);
}

/// What the first n points add in double precision; `one`: what point l gives.
template <int D, class One>
typename TileGrid<D>::Buffer expected_sums(const SixteenPoints<D>& points, std::size_t n, TileRows& rows,
                                           One one) {
  typename TileGrid<D>::Buffer sums{};
  rows = 0;
  for (std::size_t l = 0; l < n; ++l) {
    f64x4 value = {}, slope[D] = {}, moment[D] = {};
    one(l, value, slope, moment);
    scatter<D, 3>(&sums[static_cast<std::size_t>(points.base(l))], points.one(l), value, slope, moment);
    rows |= stencil_rows<D>(points.base(l));
  }
  return sums;
}

template <class Single, class Double>
void expect_sums(const Single& got, const Double& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i)
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(static_cast<double>(got[i][c]), expected[i][c], 16.0 * rounding) << i << ' ' << c;
}

template <int D>
SingleMomenta<D> random_momenta(std::mt19937& random) {
  SingleMomenta<D> momenta;
  for (f32x16& value : momenta.value) value = random_singles(random, 1.0);
  for (auto& moment : momenta.moment)
    for (f32x16& component : moment) component = random_singles(random, 1.0 / h);
  return momenta;
}
template <int D>
SingleImpulses<D> random_impulses(std::mt19937& random) {
  SingleImpulses<D> impulses;
  for (f32x16& value : impulses.value) value = random_singles(random, 1.0);
  for (auto& slope : impulses.slope)
    for (f32x16& component : slope) component = random_singles(random, h);
  return impulses;
}

template <int D>
void momenta_as_double_has_them(const Case& of) {
  const SixteenPoints<D> points(of);
  std::mt19937 random(4);
  const SingleMomenta<D> momenta = random_momenta<D>(random);
  // In double precision moments are about the point.
  const auto one = [&](std::size_t l, f64x4& value, f64x4*, f64x4* moment) {
    for (int c = 0; c <= D; ++c) value[c] = static_cast<double>(momenta.value[c][l]);
    for (int d = 0; d < D; ++d)
      for (int c = 0; c < D; ++c) {
        moment[d][c] = static_cast<double>(momenta.moment[d][c][l]);
        value[c] -= moment[d][c] * static_cast<double>(points.with_arms.middle[d][l]);
      }
  };
  for (const std::size_t n : numbers_of_points) {
    TileRows rows;
    const auto expected = expected_sums<D>(points, n, rows, one);
    typename TileGrid<D>::SingleBuffer got{};
    const Reached reached = points.give(momenta, n, got.data());
    EXPECT_EQ(reached.rows, rows);
    EXPECT_GE(reached.runs, 1);
    expect_sums(got, expected);
  }
}

template <int D>
void impulses_as_double_has_them(const Case& of) {
  const SixteenPoints<D> points(of);
  std::mt19937 random(5);
  const SingleImpulses<D> impulses = random_impulses<D>(random);
  for (const bool values : {false, true}) {
    const auto one = [&](std::size_t l, f64x4& value, f64x4* slope, f64x4*) {
      for (int c = 0; c < D && values; ++c) value[c] = static_cast<double>(impulses.value[c][l]);
      for (int d = 0; d < D; ++d)
        for (int c = 0; c < D; ++c) slope[d][c] = static_cast<double>(impulses.slope[d][c][l]);
    };
    for (const std::size_t n : numbers_of_points) {
      TileRows rows;
      const auto expected = expected_sums<D>(points, n, rows, one);
      typename TileGrid<D>::SingleBuffer got{};
      const Reached reached = values
                                  ? scatter_impulses<D, true>(points.with_slopes, impulses, n, got.data())
                                  : scatter_impulses<D, false>(points.with_slopes, impulses, n, got.data());
      EXPECT_EQ(reached.rows, rows);
      EXPECT_GE(reached.runs, 1);
      expect_sums(got, expected);
    }
  }
}

/// Sums over a cube and the largest entry of it.
template <class Cube>
std::pair<f64x4, double> total_of(const Cube& cube) {
  f64x4 total = {};
  double largest = 0.0;
  for (const f32x4& node : cube) {
    total += in_double(node);
    for (int c = 0; c < 4; ++c) largest = std::max(largest, std::abs(static_cast<double>(node[c])));
  }
  return {total, largest};
}

// Stresses move no momentum but from one node to another, and what points give in mass and momentum about
// themselves all arrives: to a rounding, 6e-8, of each of the 3^D entries of every point.
template <int D>
void nothing_is_lost(const Case& of) {
  const SixteenPoints<D> points(of);
  std::mt19937 random(6);
  const SingleImpulses<D> impulses = random_impulses<D>(random);
  typename TileGrid<D>::SingleBuffer pushed{}, moved{};
  scatter_impulses<D, false>(points.with_slopes, impulses, f32x16_size, pushed.data());
  const double tolerance = power(3, D) * f32x16_size * 6e-8;
  const auto [push, hardest] = total_of(pushed);
  EXPECT_GT(hardest, 0.1);
  for (int c = 0; c < D; ++c) EXPECT_NEAR(push[c], 0.0, tolerance * hardest);

  const SingleMomenta<D> momenta = random_momenta<D>(random);
  points.give(momenta, f32x16_size, moved.data());
  const auto [sum, most] = total_of(moved);
  for (int c = 0; c <= D; ++c) {
    double given = 0.0;
    for (std::size_t l = 0; l < f32x16_size; ++l) {
      given += static_cast<double>(momenta.value[c][l]);
      // The arms of a point's nodes from its middle one average to minus the middle one's from the point.
      for (int d = 0; d < D && c < D; ++d)
        given -=
            static_cast<double>(momenta.moment[d][c][l]) * static_cast<double>(points.with_arms.middle[d][l]);
    }
    EXPECT_NEAR(sum[c], given, tolerance * std::max(most, 1.0));
  }
}

class SingleSums : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Cells, SingleSums,
                         testing::Values(Case{ShapeFunctions::b_spline, 0.21, 0.29},
                                         Case{ShapeFunctions::b_spline, 0.0, 0.4},
                                         Case{ShapeFunctions::gimp, 0.21, 0.24},
                                         Case{ShapeFunctions::gimp, 0.001, 0.4}));
TEST_P(SingleSums, StencilsBeginAlike) {
  stencils_begin_alike<2>(GetParam()), stencils_begin_alike<3>(GetParam());
}
TEST_P(SingleSums, GatherAsDoubleDoes) {
  gather_as_double_does<2>(GetParam()), gather_as_double_does<3>(GetParam());
}
TEST_P(SingleSums, WhatFillsUpReadsAsItsFirst) {
  what_fills_up_reads_as_its_first<2>(GetParam()), what_fills_up_reads_as_its_first<3>(GetParam());
}
TEST_P(SingleSums, InertiaAsDoubleHasIt) {
  inertia_as_double_has_it<2>(GetParam()), inertia_as_double_has_it<3>(GetParam());
}
TEST_P(SingleSums, MomentaAsDoubleHasThem) {
  momenta_as_double_has_them<2>(GetParam()), momenta_as_double_has_them<3>(GetParam());
}
TEST_P(SingleSums, ImpulsesAsDoubleHasThem) {
  impulses_as_double_has_them<2>(GetParam()), impulses_as_double_has_them<3>(GetParam());
}
TEST_P(SingleSums, NothingIsLost) { nothing_is_lost<2>(GetParam()), nothing_is_lost<3>(GetParam()); }

// A point on a wall, wherever the axis begins, is in the wall's cell for all who ask, and its node on the
// wall has all the weight; GIMP's hats there are as wide as 1e-16 of a cell.
TEST(OnAWall, TheWallsControlHasAllTheWeight) {
  constexpr int D = 2;
  for (const double origin : {0.0, 0.3, -0.2, 1e3})
    for (const ShapeFunctions kind : {ShapeFunctions::b_spline, ShapeFunctions::gimp}) {
      const auto axes = held_axes<D>(origin);
      const auto shape = shape_of<D>(kind);
      const std::array<f64x8, D> x = {all_lanes(origin), all_lanes(origin)}, both[2] = {x, x};
      Weights<D> weights;
      SingleWeights<D> single;
      weigh<D>(axes, shape, {}, x, weights);
      const auto frame = stencil_frame<D>(axes, shape, {});
      with_kind(kind, [&](auto k) { weigh_single<k, WeighedFor::stress, D>(frame, both, single); });
      const std::size_t on_wall = kind == ShapeFunctions::gimp ? 1 : 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double all = k == on_wall ? 1.0 : 0.0;
        EXPECT_NEAR(weights.w[0][k][0], all, 1e-16) << origin;
        EXPECT_NEAR(static_cast<double>(single.w[0][k][0]), all, 1e-16) << origin;
      }
      EXPECT_EQ(single.base[0], weights.base[0]);
      std::array<int, f64x8_size> cell, single_cell;
      find_pressure_cells<D, double>(frame, x, cell);
      find_pressure_cells<D, float>(frame, x, single_cell);
      EXPECT_EQ(cell[0], 2 * tile_pressure_cells + 2);
      EXPECT_EQ(single_cell[0], cell[0]);
    }
}

// A place that single precision rounds up into the next cell puts stencil and pressure cell there together.
TEST(PressureCellsInSingle, AreTheStencils) {
  constexpr int D = 2;
  const auto axes = held_axes<D>(0.0);
  const auto shape = shape_of<D>(ShapeFunctions::b_spline);
  const std::array<f64x8, D> x = {all_lanes(0.3 - 1e-10), all_lanes(0.25)}, both[2] = {x, x};
  SingleWeights<D> single;
  const auto frame = stencil_frame<D>(axes, shape, {});
  weigh_single<ShapeFunctions::b_spline, WeighedFor::stress, D>(frame, both, single);
  std::array<int, f64x8_size> cell;
  find_pressure_cells<D, float>(frame, x, cell);
  EXPECT_EQ(single.base[0], 4 * tile_span + 3);
  EXPECT_EQ(cell[0], 5 * tile_pressure_cells + 4);
  find_pressure_cells<D, double>(frame, x, cell);
  EXPECT_EQ(cell[0], 4 * tile_pressure_cells + 4);
}

}  // namespace
}  // namespace tremie
