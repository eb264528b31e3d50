// The strain-rate rows of the spaces and the splines of an axis against their definitions.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "libmpm/geometry/polar.hpp"
#include "libmpm/grid/active_grid.hpp"
#include "libmpm/transfer/apic.hpp"

namespace tremie {
namespace {

/// sqrt(2 D':D') of a full 3x3 velocity gradient, the definition.
double shear_rate_of(const Eigen::Matrix3d& L) {
  Eigen::Matrix3d D = 0.5 * (L + L.transpose());
  D -= D.trace() / 3.0 * Eigen::Matrix3d::Identity();
  return std::sqrt(2.0 * D.cwiseProduct(D).sum());
}

/// The 3x3 velocity gradient of the field v = v0 + L x at x.
template <class Geometry>
Eigen::Matrix3d gradient_3d(const Vec<Geometry::dim>& v, const Mat<Geometry::dim, Geometry::dim>& L,
                            const Vec<Geometry::dim>& x) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  G.topLeftCorner(Geometry::dim, Geometry::dim) = L;
  if constexpr (std::is_same_v<Geometry, Axisymmetric>) {  // order r, z, theta; the hoop rate is v_r / r
    G(2, 2) = v[0] / x[0];
  }
  if constexpr (std::is_same_v<Geometry, Polar>) {  // derivatives along theta are over r, and the basis turns
    G(0, 1) = (L(0, 1) - v[1]) / x[0];
    G(1, 1) = (L(1, 1) + v[0]) / x[0];
  }
  return G;
}

template <class Geometry>
class Spaces : public testing::Test {};
using AllSpaces = testing::Types<Axisymmetric, PlaneStrain, Polar, ThreeD>;
TYPED_TEST_SUITE(Spaces, AllSpaces);

// A linear velocity field, sampled at the nodes of cells in the open and next to walls, must give the
// exact shear rate and divergence anywhere in the cell: |q| = sqrt(2 D':D') with the hoop terms, linear
// completeness of the splines.
TYPED_TEST(Spaces, ShearRateAndDivergenceOfLinearFields) {
  using Geometry = TypeParam;
  constexpr int D = Geometry::dim;
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    std::array<Axis, D> axes;
    Index<D> cell;
    Vec<D> s, v0;
    Mat<D, D> L;
    for (int d = 0; d < D; ++d) {
      axes[d] = {.h = 0.01 * (1 + d),
                 .low = FaceKind::no_slip,
                 .high = FaceKind::free_slip,
                 .n_cells = 1 + trial % 4};
      cell[d] = trial / 4 % axes[d].n_cells;
      s[d] = 0.5 + 0.499 * number(engine);
      v0[d] = number(engine);
      for (int e = 0; e < D; ++e) L(d, e) = number(engine);
    }
    const Vec<D> x = position_in_cell<D>(axes, cell, s);
    const Stencil<D> st = stencil<D>(axes, cell, s);
    Vec<Geometry::n_strain> q = Vec<Geometry::n_strain>::Zero();
    double div = 0.0;
    for (int k = 0; k < Stencil<D>::n; ++k) {
      Vec<D> node;
      for (int d = 0; d < D; ++d) node[d] = axes[d].node_position(cell[d] + local_offset<D>(k)[d]);
      const Vec<D> u = v0 + L * node;
      q += Geometry::strain_rows(st.N[k], st.g[k], x) * u;
      div += Geometry::divergence_row(st.N[k], st.g[k], x).dot(u);
    }
    const Eigen::Matrix3d G = gradient_3d<Geometry>(v0 + L * x, L, x);
    // Round-off: nodes are some h apart and the gradients of size 1/h cancel to size 1.
    EXPECT_NEAR(q.norm() / shear_rate_of(G), 1.0, 1e-11);
    EXPECT_NEAR(div, G.trace(), 1e-11 * (1.0 + G.norm()));
  }
}

/// All kinds of ends: open, walls at one or both ends, few cells between them.
std::vector<Axis> axes() {
  std::vector<Axis> all;
  for (int n : {1, 2, 3, 7})
    for (FaceKind low : {FaceKind::open, FaceKind::no_slip})
      for (FaceKind high : {FaceKind::open, FaceKind::free_slip})
        all.push_back({.h = 0.3, .origin = -1.0, .low = low, .high = high, .n_cells = n});
  return all;
}

/// The same with repeated knots: one, two next to each other, two apart.
std::vector<Axis> axes_and_repeated() {
  std::vector<Axis> all = axes();
  for (Axis a : axes()) {
    if (a.n_cells < 7) continue;
    for (const std::vector<int>& repeated_knots : {std::vector{1}, {6}, {3, 4}, {2, 5}}) {
      a.repeated_knots = repeated_knots;
      all.push_back(a);
    }
  }
  return all;
}

TEST(Splines, PartitionOfUnityAndLinearCompleteness) {
  for (const Axis& a : axes_and_repeated())
    for (int c = 0; c < a.n_cells; ++c)
      for (double s = 0.0; s <= 1.0; s += 0.05) {
        const SplineValues v = splines(a, c, s);
        double sum = 0, slope_sum = 0, place = 0, slope = 0;
        for (int k = 0; k < 3; ++k) {
          EXPECT_GE(v.N[k], 0.0);
          sum += v.N[k], slope_sum += v.dN[k];
          const double node = a.node_position(a.first_node(c) + k);
          place += v.N[k] * node, slope += v.dN[k] * node;
        }
        EXPECT_NEAR(sum, 1.0, 1e-14);
        EXPECT_NEAR(slope_sum, 0.0, 1e-13);
        EXPECT_NEAR(place, a.origin + (c + s) * a.h, 1e-14);
        EXPECT_NEAR(slope, 1.0, 1e-13);
      }
}

// Once continuously differentiable across cells, the end spline 1 on its wall, derivatives those of the
// values.
TEST(Splines, SmoothAndInterpolatoryOnWalls) {
  for (const Axis& a : axes()) {
    for (int c = 0; c + 1 < a.n_cells; ++c) {
      const SplineValues left = splines(a, c, 1.0), right = splines(a, c + 1, 0.0);
      for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(left.N[k + 1], right.N[k], 1e-14);
        EXPECT_NEAR(left.dN[k + 1], right.dN[k], 1e-13);
      }
      EXPECT_NEAR(left.N[0], 0.0, 1e-15);
      EXPECT_NEAR(right.N[2], 0.0, 1e-15);
    }
    if (a.wall_low()) {
      EXPECT_EQ(splines(a, 0, 0.0).N[0], 1.0);
    }
    if (a.wall_high()) {
      EXPECT_EQ(splines(a, a.n_cells - 1, 1.0).N[2], 1.0);
    }
    for (int c = 0; c < a.n_cells; ++c) {
      const double e = 1e-4;  // a central difference is exact on quadratics
      const SplineValues v = splines(a, c, 0.37), low = splines(a, c, 0.37 - e),
                         high = splines(a, c, 0.37 + e);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR((high.N[k] - low.N[k]) / (2 * e * a.h), v.dN[k], 1e-10);
    }
  }
}

// A repeated knot belongs to one node, the last of the cell below and the first of the cell above; elsewhere the
// splines go on smoothly, a node further for every repeated knot.
TEST(Splines, AreC0AtRepeatedKnotsAlone) {
  for (const Axis& a : axes_and_repeated())
    for (int c = 0; c + 1 < a.n_cells; ++c) {
      const SplineValues left = splines(a, c, 1.0), right = splines(a, c + 1, 0.0);
      if (a.repeated(c + 1)) {
        EXPECT_EQ(a.first_node(c) + 2, a.first_node(c + 1));
        EXPECT_EQ(a.node_position(a.first_node(c + 1)), a.origin + (c + 1) * a.h);
        EXPECT_EQ(left.N[2], 1.0);
        EXPECT_EQ(right.N[0], 1.0);
      } else {
        EXPECT_EQ(a.first_node(c) + 1, a.first_node(c + 1));
        for (int k = 0; k < 2; ++k) EXPECT_NEAR(left.dN[k + 1], right.dN[k], 1e-13);
      }
    }
}

/// Integral of node j's spline over the cells that exist [m]: its share of the line. Without repeated knots.
double spline_integral(const Axis& axis, int j) {
  double share = 1.0;
  if (axis.wall_low()) share = j == 0 ? 1.0 / 3.0 : j == 1 ? 2.0 / 3.0 : share;
  if (axis.wall_high()) {
    const int k = axis.n_cells + 1 - j;
    share -= k == 0 ? 2.0 / 3.0 : k == 1 ? 1.0 / 3.0 : 0.0;
  }
  return share * axis.h;
}

// The integral of every spline over the cells that exist, by Simpson's rule, exact on quadratics.
TEST(Splines, Integrals) {
  for (const Axis& a : axes())
    for (int j = 0; j < a.n_cells + 2; ++j) {
      // An open end goes on: a spline there reaches over cells beyond.
      double sum = 0.0;
      for (int c = j - 2; c <= j; ++c) {
        if ((a.wall_low() && c < 0) || (a.wall_high() && c >= a.n_cells)) continue;
        const auto k = static_cast<std::size_t>(j - c);
        sum += a.h / 6 * (splines(a, c, 0).N[k] + 4 * splines(a, c, 0.5).N[k] + splines(a, c, 1).N[k]);
      }
      EXPECT_NEAR(spline_integral(a, j), sum, 1e-14) << j << " of " << a.n_cells;
    }
}

// Periodic axes of one, two and three cells: mass and momentum pass from points to nodes and back to
// round-off.
TEST(Transfer, MomentumOnShortPeriodicAxes) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  for (int n : {1, 2, 3}) {
    ActiveGrid<2> grid;
    grid.axes[0] = {.h = 0.1, .periodic = true, .n_cells = n};
    grid.axes[1] = {.h = 0.07, .low = FaceKind::free_slip, .repeated_knots = {1}};
    if (n == 3) grid.axes[0].repeated_knots = {1, 2};
    Points<2> points;
    double mass = 0.0;
    Vec<2> momentum = Vec<2>::Zero();
    for (int p = 0; p < 40; ++p) {
      add_point<2>(points, {0.1 * n * number(engine), 0.2 * number(engine)}, 0.5 + number(engine), 1e-3, 0.0);
      points.v.back() = {number(engine), number(engine) - 2.0};
      mass += points.mass.back();
      momentum += points.mass.back() * points.v.back();
    }
    activate(grid, points.x);
    NodalState<2> nodes;
    point_to_grid(grid, points, nodes);
    double node_mass = 0.0;
    Vec<2> node_momentum = Vec<2>::Zero();
    for (int i = 0; i < grid.n_nodes(); ++i) {
      node_mass += nodes.mass[static_cast<std::size_t>(i)];
      node_momentum += nodes.mass[static_cast<std::size_t>(i)] * nodes.v[static_cast<std::size_t>(i)];
    }
    EXPECT_NEAR(node_mass / mass, 1.0, 1e-14);
    EXPECT_LE((node_momentum - momentum).norm(), 1e-13 * momentum.norm());
    grid_to_point<2>(grid, nodes.v, nodes.v, {}, 1e-3, points);
    Vec<2> after = Vec<2>::Zero();
    for (std::size_t p = 0; p < points.size(); ++p) after += points.mass[p] * points.v[p];
    EXPECT_LE((after - momentum).norm(), 1e-13 * momentum.norm());
    for (const Vec<2>& x : points.x) EXPECT_TRUE(x[0] >= 0.0 && x[0] < 0.1 * n);
  }
}

// A uniform velocity stays uniform, also where one node serves several places of a cell.
TEST(Transfer, UniformVelocityOnShortPeriodicAxes) {
  for (int n : {1, 2}) {
    ActiveGrid<2> grid;
    grid.axes[0] = {.h = 0.1, .periodic = true, .n_cells = n};
    grid.axes[1] = {.h = 0.1};
    Points<2> points;
    for (int p = 0; p < 10; ++p) {
      add_point<2>(points, {0.1 * n * (p + 0.5) / 10.0, 0.05 + 0.017 * p}, 1.0, 1e-3, 0.0);
      points.v.back() = {3.0, -1.0};
    }
    activate(grid, points.x);
    NodalState<2> nodes;
    point_to_grid(grid, points, nodes);
    for (const Vec<2>& v : nodes.v) EXPECT_LE((v - Vec<2>(3.0, -1.0)).norm(), 1e-13);
    grid_to_point<2>(grid, nodes.v, nodes.v, {}, 1e-3, points);
    for (const Mat<2, 2>& C : points.C) EXPECT_LE(C.norm(), 1e-11);
  }
}

}  // namespace
}  // namespace tremie
