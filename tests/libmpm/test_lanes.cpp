// Eight points at once: functions, laws, rates and shape functions against their scalar twins.

#include <gtest/gtest.h>

#include <random>

#include "libmpm/constitutive/flocculation.hpp"
#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/explicit/tiled_particles.hpp"
#include "libmpm/geometry/gradients.hpp"
#include "libmpm/transfer/shape_functions.hpp"

namespace tremie {
namespace {

f64x8 random_lanes(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> u(low, high);
  f64x8 a;
  for (int l = 0; l < f64x8_size; ++l) a[l] = u(random);
  return a;
}

// Four units in the last place: the polynomial's rounding.
TEST(LaneFunctions, ExpAndMeanDecay) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const double reach = std::pow(10.0, -8.0 + 10.8 * i / 2000.0);
    const f64x8 x = random_lanes(random, -reach, reach), y = exp(x);
    const f64x8 z = max(x, -x), d = mean_decay(z), left = decay(z);
    for (int l = 0; l < f64x8_size; ++l) {
      EXPECT_NEAR(y[l] / std::exp(x[l]), 1.0, 1e-15);
      EXPECT_NEAR(d[l] / (-std::expm1(-z[l]) / z[l]), 1.0, 2e-15);
      EXPECT_NEAR(left[l] / std::exp(-z[l]), 1.0, 1e-15);
    }
  }
  EXPECT_EQ(exp(f64x8{})[0], 1.0);
  EXPECT_EQ(mean_decay(f64x8{})[0], 1.0);
  EXPECT_GT(exp(all_lanes(-1e5))[3], 0.0);
  EXPECT_TRUE(std::isfinite(exp(all_lanes(1e5))[3]));
}

// The whole number between two goes to the even one.
TEST(LaneFunctions, FloorAndNearest) {
  const f64x8 x = {-2.0, -1.5, -0.1, 0.0, 0.5, 1.0, 2.5, 1e6 + 0.5}, f = floor(x), n = nearest(x);
  const f32x8 y = to_real<float>(x), g = floor(y), m = nearest(y);
  const auto whole = to_integers(g);
  for (std::size_t l = 0; l < f64x8_size; ++l) {
    EXPECT_EQ(f[l], std::floor(x[l]));
    EXPECT_EQ(n[l], std::nearbyint(x[l]));
    EXPECT_EQ(g[l], std::floor(y[l]));
    EXPECT_EQ(m[l], std::nearbyint(y[l]));
    EXPECT_EQ(whole[l], static_cast<int>(std::floor(y[l])));
    EXPECT_EQ(to_double(y)[l], x[l] == -0.1 ? static_cast<double>(-0.1F) : x[l]);
  }
}

TEST(LaneLaws, AsTheScalarLaws) {
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    const f64x8 gamma = random_lanes(random, 0.0, std::pow(10.0, -9.0 + i / 45.0));
    const f64x8 tau_y = random_lanes(random, 1.0, 900.0);
    const Papanastasiou smooth{5.0};
    const BiViscous broken{0.01};
    const f64x8 a = secant(smooth, gamma, tau_y), b = secant(broken, gamma, tau_y);
    for (int l = 0; l < f64x8_size; ++l) {
      EXPECT_NEAR(a[l] / smooth.secant(gamma[l], tau_y[l]), 1.0, 1e-10);  // the scalar series below 1e-5
      EXPECT_DOUBLE_EQ(b[l], broken.secant(gamma[l], tau_y[l]));
      EXPECT_LE(a[l], largest_secant(smooth, tau_y[l]) * (1.0 + 1e-15));
      EXPECT_LE(b[l], largest_secant(broken, tau_y[l]));
    }
  }
}

// Both kinetics at rates on either side of the gate and across it.
TEST(LaneLaws, FlocculationAsTheScalarUpdate) {
  std::mt19937 random(3);
  for (const Kinetics& kinetics : {Kinetics{GatedKinetics{0.03}}, Kinetics{RousselKinetics{0.03}}})
    for (int i = 0; i < 500; ++i) {
      const Thixotropy t{1.3, kinetics};
      const f64x8 lambda = random_lanes(random, 0.0, 7.0);
      const f64x8 g0 = random_lanes(random, 0.0, i % 2 ? 0.2 : 10.0);
      const f64x8 g1 = random_lanes(random, 0.0, i % 3 ? 0.2 : 10.0);
      const f64x8 next = flocculation_step(lambda, t, 54.0, g0, g1, 0.37);
      for (int l = 0; l < f64x8_size; ++l)
        EXPECT_NEAR(next[l], flocculation_step(lambda[l], t, 54.0, g0[l], g1[l], 0.37), 1e-13);
    }
}

template <class Geometry>
class Gradients : public testing::Test {};
using SpaceTypes = testing::Types<Axisymmetric, PlaneStrain, ThreeD>;
TYPED_TEST_SUITE(Gradients, SpaceTypes);

// q and div of a random stencil are the sums of the space's rows, and the power of a stress is s.q - p div.
TYPED_TEST(Gradients, AreTheRowsSummedUp) {
  constexpr int D = TypeParam::dim, ns = TypeParam::n_strain;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Vec<D> x = Vec<D>::Constant(0.3);
  Vec<ns> q = Vec<ns>::Zero();
  Vec<D> v = Vec<D>::Zero();
  Mat<D, D> slope = Mat<D, D>::Zero();
  double div = 0.0;
  for (int i = 0; i < 9; ++i) {
    const double N = u(random);
    Vec<D> g, vi;
    for (int d = 0; d < D; ++d) g[d] = u(random), vi[d] = u(random);
    q += TypeParam::strain_rows(N, g, x) * vi;
    div += TypeParam::divergence_row(N, g, x).dot(vi);
    v += N * vi, slope += vi * g.transpose();
  }
  double L[D][D], rate[ns], divergence, s[ns], sigma[D][D], hoop;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) L[a][b] = slope(a, b);
  strain_rate_of<TypeParam, double>(L, v[0], x[0], rate, divergence);
  EXPECT_NEAR(divergence, div, 1e-13);
  double power = 0.0;
  for (int k = 0; k < ns; ++k) {
    EXPECT_NEAR(rate[k], q[k], 1e-13);
    s[k] = u(random), power += s[k] * q[k];
  }
  const double p = 3.7;
  stress_tensor_of<TypeParam, double>(s, p, sigma, hoop);
  double work = std::is_same_v<TypeParam, Axisymmetric> ? hoop * v[0] / x[0] : 0.0;
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b) work += sigma[a][b] * slope(a, b);
  EXPECT_NEAR(work, power - p * div, 1e-12);
}

class ShapeFunctionsOfLanes : public testing::TestWithParam<ShapeFunctions> {};

// Everywhere between two walls, in both shapes: values sum to one and give back the place, slopes those of
// the place; none is negative, so that a node's mass is not. On a wall its node has all the weight.
TEST_P(ShapeFunctionsOfLanes, PartitionOfUnityAndLinearFields) {
  const std::array<Axis, 2> axes = {
      Axis{.h = 0.02, .origin = -0.1, .low = FaceKind::no_slip, .high = FaceKind::no_slip, .n_cells = 6},
      Axis{.h = 0.01, .low = FaceKind::free_slip}};
  const Shape<2> shape{GetParam(), {0.25, 0.2}};
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    const int tile = i % 2;  // the high wall lies in the second one
    std::array<f64x8, 2> x = {random_lanes(random, -0.1 + 0.08 * tile, tile ? 0.02 : -0.02),
                              random_lanes(random, 0.0, 0.04)};
    if (i == 0) x[0] = all_lanes(-0.1);
    Weights<double, 2> weights;
    weigh<double, 2>({axes, shape, {tile, 0}}, x, weights);
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < f64x8_size; ++l) {
        const int base = d == 0 ? weights.base[static_cast<std::size_t>(l)] / tile_span
                                : weights.base[static_cast<std::size_t>(l)] % tile_span;
        double one = 0.0, place = 0.0, flat = 0.0, slope = 0.0;
        for (int k = 0; k < 3; ++k) {
          const int node = (d == 0 ? tile : 0) * tile_cells - 1 + base + k;
          const double at = GetParam() == ShapeFunctions::gimp ? axes[d].origin + (node - 1) * axes[d].h
                                                               : axes[d].node_position(node);
          const double w = weights.w[d][k][l], dw = weights.dw[d][k][l];
          EXPECT_GE(w, -1e-16);
          EXPECT_NEAR(weights.wa[d][k][l], w * (at - x[d][l]), 1e-15);
          one += w, place += w * at, flat += dw, slope += dw * at;
        }
        EXPECT_NEAR(one, 1.0, 1e-14);
        EXPECT_NEAR(place, x[d][l], 1e-15);
        EXPECT_NEAR(flat, 0.0, 1e-11);
        EXPECT_NEAR(slope, 1.0, 1e-12);
      }
    if (i == 0) {
      EXPECT_NEAR(weights.w[0][GetParam() == ShapeFunctions::gimp ? 1 : 0][0], 1.0, 1e-15);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Shapes, ShapeFunctionsOfLanes,
                         testing::Values(ShapeFunctions::b_spline, ShapeFunctions::gimp));

// Sorted points are all there once, in tiles in their order, cell by cell.
TEST(SortedPoints, AreInTheirTilesCellByCell) {
  constexpr int D = 2;
  std::array<Axis, D> axes;
  for (Axis& a : axes) a = {.h = 0.1};
  Points<D> points;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int p = 0; p < 1000; ++p) add_point<D>(points, {u(random), u(random)}, 1.0 + p, 1.0, 0.0);
  LanePoints<D> lanes;
  Points<D> taken = points;
  take_points<D>(taken, true, false, lanes);
  const auto tiles = sort_into_tiles<D>(axes, 0.0, lanes);
  std::vector<int> seen(points.size(), 0);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    const Tile<D>& tile = tiles[t];
    if (t > 0) {
      EXPECT_LT(tiles[t - 1].at, tile.at);
    }
    Index<D> last = {std::numeric_limits<int>::min(), 0};
    for (int g = tile.first_group; g < tile.last_group; ++g) {
      for (int l = 0; l < f64x8_size; ++l) {
        const int id = lanes.id[static_cast<std::size_t>(g)][static_cast<std::size_t>(l)];
        if (id < 0) {
          EXPECT_EQ(lanes.mass[static_cast<std::size_t>(g)][l], 0.0);
          continue;
        }
        ++seen[static_cast<std::size_t>(id)];
        EXPECT_EQ(lanes.mass[static_cast<std::size_t>(g)][l], 1.0 + id);
        Index<D> cell;
        for (int d = 0; d < D; ++d) {
          cell[d] = static_cast<int>(std::floor(points.x[static_cast<std::size_t>(id)][d] / axes[d].h));
          EXPECT_EQ(tile.at[d], static_cast<int>(std::floor(cell[d] / double(tile_cells))));
        }
        EXPECT_LE(last, cell);
        last = cell;
      }
    }
  }
  for (const int n : seen) EXPECT_EQ(n, 1);
}

}  // namespace
}  // namespace tremie
