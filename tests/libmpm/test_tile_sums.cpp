// Grid to points and points to grid over a tile's nodes, in both precisions, against plain sums in double.

#include <gtest/gtest.h>

#include <random>

#include "libmpm/transfer/tile_sums.hpp"

namespace tremie {
namespace {

constexpr double h = 0.1;

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

/// Eight points in cells next to a wall and away from it, and random nodes.
template <class Real, int D>
struct EightPoints {
  Weights<Real, D> weights;
  NodeCube<Real, D> v;
  AtPoints<Real, D, 1> given = {};

  explicit EightPoints(ShapeFunctions kind) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(0.0, 0.35), u(-1.0, 1.0);
    std::array<f64x8, D> x;
    for (f64x8& lanes : x)
      for (int l = 0; l < f64x8_size; ++l) lanes[l] = place(random);
    weigh<Real, D>({held_axes<D>(0.0), shape_of<D>(kind), {}}, x, weights);
    const auto fill = [&](auto& of, int n, double size) {
      for (int i = 0; i < n; ++i) of[i] = static_cast<Real>(size * u(random));
    };
    for (auto& node : v) fill(node, 4, 1.0);
    for (auto& component : given.value) fill(component, f64x8_size, 1.0);
    for (auto& of_direction : given.along[0])
      for (int c = 0; c < D; ++c) fill(of_direction[c], f64x8_size, 1.0);
  }
};

/// The weight of point l at its k-th node, and with a in place of w in each direction.
template <int D, class Real>
std::array<double, D + 1> plain_weights(const Weights<Real, D>& weights, const SimdOf<Real> (&a)[D][3], int l,
                                        int k) {
  std::array<double, D + 1> products;
  products.fill(1.0);
  const Index<D> o = local_offset<D>(k);
  for (int e = 0; e <= D; ++e)
    for (int d = 0; d < D; ++d) products[e] *= static_cast<double>((d + 1 == e ? a : weights.w)[d][o[d]][l]);
  return products;
}

template <int D>
int node_of(int base, int k) {
  const Index<D> o = local_offset<D>(k);
  for (int d = 0; d < D; ++d) base += o[d] * stride<D>(tile_span, d);
  return base;
}

/// A dozen roundings of a sum of numbers up to `size`.
template <class Real>
constexpr double rounding(double size) {
  return size * (std::is_same_v<Real, float> ? 2e-6 : 4e-15);
}

// `size`: of the weights a.
template <class Real, int D>
void sums_are_the_plain_ones(const EightPoints<Real, D>& points, const SimdOf<Real> (&a)[D][3], double size) {
  AtPoints<Real, D, 1> got;
  NodeCube<Real, D> sums{};
  gather<Real, D, 1>(points.v, points.weights, {a}, got);
  constexpr int n = 7;  // the last fills up the group
  scatter<Real, D, 1>(points.weights, {a}, points.given, n, sums);
  std::array<std::array<double, 4>, power(tile_span, D)> expected{};
  for (int l = 0; l < f64x8_size; ++l) {
    const int base = points.weights.base[static_cast<std::size_t>(l)];
    std::array<std::array<double, 4>, D + 1> read{};
    for (int k = 0; k < power(3, D); ++k) {
      const auto w = plain_weights<D, Real>(points.weights, a, l, k);
      const int node = node_of<D>(base, k);
      for (int c = 0; c < 4; ++c) {
        double give = w[0] * static_cast<double>(points.given.value[c][l]);
        for (int e = 0; e <= D; ++e) read[e][c] += w[e] * static_cast<double>(points.v[node][c]);
        for (int d = 0; d < D; ++d) give += w[d + 1] * static_cast<double>(points.given.along[0][d][c][l]);
        if (l < n) expected[node][c] += give;
      }
    }
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(static_cast<double>(got.value[c][l]), read[0][c], rounding<Real>(1.0));
    for (int d = 0; d < D; ++d)
      for (int c = 0; c < D; ++c)
        EXPECT_NEAR(static_cast<double>(got.along[0][d][c][l]), read[d + 1][c], rounding<Real>(size));
  }
  for (std::size_t i = 0; i < expected.size(); ++i)
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(static_cast<double>(sums[i][c]), expected[i][c], rounding<Real>(8.0 * (1.0 + size)));
}

template <class Real>
class TileSums : public testing::Test {};
using Precisions = testing::Types<double, float>;
TYPED_TEST_SUITE(TileSums, Precisions);

template <class Real, int D>
void slopes_and_moments(ShapeFunctions kind) {
  const EightPoints<Real, D> points(kind);
  sums_are_the_plain_ones<Real, D>(points, points.weights.dw, 3.0 / h);
  sums_are_the_plain_ones<Real, D>(points, points.weights.wa, h);
}
TYPED_TEST(TileSums, AreThePlainOnes) {
  for (const ShapeFunctions kind : {ShapeFunctions::b_spline, ShapeFunctions::gimp})
    slopes_and_moments<TypeParam, 2>(kind), slopes_and_moments<TypeParam, 3>(kind);
}

// Stresses move no momentum but from one node to another: to a rounding of each of the entries.
TYPED_TEST(TileSums, ImpulsesAddUpToNothing) {
  constexpr int D = 3;
  EightPoints<TypeParam, D> points(ShapeFunctions::gimp);
  for (auto& value : points.given.value) value = SimdOf<TypeParam>{};
  NodeCube<TypeParam, D> sums{};
  scatter<TypeParam, D, 1>(points.weights, {points.weights.dw}, points.given, f64x8_size, sums);
  double total = 0.0, hardest = 0.0;
  for (const auto& node : sums)
    total += static_cast<double>(node[0]),
        hardest = std::max(hardest, std::abs(static_cast<double>(node[0])));
  EXPECT_GT(hardest, 0.1);
  EXPECT_NEAR(total, 0.0, rounding<TypeParam>(27.0 * hardest));
}

// A point on a wall, wherever the axis begins, is in the wall's cell, and its node on the wall has all the weight; GIMP's
// hats there are as wide as 1e-16 of a cell.
TYPED_TEST(TileSums, OnAWallItsNodeHasAllTheWeight) {
  constexpr int D = 2;
  for (const double origin : {0.0, 0.3, -0.2, 1e3})
    for (const ShapeFunctions kind : {ShapeFunctions::b_spline, ShapeFunctions::gimp}) {
      const StencilFrame<TypeParam, D> frame(held_axes<D>(origin), shape_of<D>(kind), {});
      const std::array<f64x8, D> x = {all_lanes(origin), all_lanes(origin)};
      Weights<TypeParam, D> weights;
      weigh<TypeParam, D>(frame, x, weights);
      const int on_wall = kind == ShapeFunctions::gimp ? 1 : 0;
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(static_cast<double>(weights.w[0][k][0]), k == on_wall ? 1.0 : 0.0, 1e-16) << origin;
      EXPECT_EQ((find_pressure_cells<TypeParam, D>(frame, x)[0]), 2 * tile_pressure_cells + 2);
    }
}

// A place that single precision rounds up into the next cell puts stencil and pressure cell there together.
TEST(PressureCellsInSingle, AreTheStencils) {
  constexpr int D = 2;
  const StencilFrame<float, D> frame(held_axes<D>(0.0), shape_of<D>(ShapeFunctions::b_spline), {});
  const std::array<f64x8, D> x = {all_lanes(0.3 - 1e-10), all_lanes(0.25)};
  Weights<float, D> weights;
  weigh<float, D>(frame, x, weights);
  EXPECT_EQ(weights.base[0], 4 * tile_span + 3);
  EXPECT_EQ((find_pressure_cells<float, D>(frame, x)[0]), 5 * tile_pressure_cells + 4);
}

}  // namespace
}  // namespace tremie
