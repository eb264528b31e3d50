// Eight points at once: functions, laws, rates and shape functions against their scalar twins.

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

#include "libmpm/constitutive/simd_laws.hpp"
#include "libmpm/constitutive/yield_law.hpp"
#include "libmpm/explicit/tiled_particles.hpp"
#include "libmpm/geometry/gradients.hpp"
#include "libmpm/transfer/simd_sums.hpp"

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
    const f64x8 z = x < 0.0 ? -x : x, d = mean_decay(z), left = decay(z);
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

// Against doubles: two units in the last place of single precision for e^x, five for the mean, where 1 -
// e^-1/2 has lost one and a half bits.
TEST(LaneFunctions, ExpAndMeanDecayInSinglePrecision) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const double reach = std::pow(10.0, -8.0 + 9.8 * i / 2000.0);
    const f32x16 x = to_single(random_lanes(random, -reach, reach), random_lanes(random, -reach, reach));
    const f32x16 y = exp(x), z = x < 0.0F ? -x : x, d = mean_decay(z);
    for (std::size_t l = 0; l < f32x16_size; ++l) {
      const double at = static_cast<double>(x[l]), far = std::abs(at);
      EXPECT_NEAR(static_cast<double>(y[l]) / std::exp(at), 1.0, 2.4e-7);
      EXPECT_NEAR(static_cast<double>(d[l]) / (-std::expm1(-far) / far), 1.0, 6e-7);
    }
  }
  EXPECT_EQ(exp(f32x16{})[0], 1.0F);
  EXPECT_EQ(mean_decay(f32x16{})[0], 1.0F);
  EXPECT_GT(exp(-1e5F - f32x16{})[3], 0.0F);
  EXPECT_TRUE(std::isfinite(exp(1e5F - f32x16{})[3]));
  EXPECT_NEAR(static_cast<double>(mean_decay(1e7F - f32x16{})[3]), 1e-7, 1e-13);
}

TEST(LaneFunctions, LookUp) {
  std::array<double, 40> table;
  std::array<float, 40> strided;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = 0.5 * double(i), strided[i] = 0.5F * float(i);
  const std::array<int, f64x8_size> a{3, 0, 3, 39, 17, 1, 8, 9}, b{1, 2, 3, 4, 5, 6, 7, 12};
  const f64x8 one = look_up(table.data(), a);
  const f32x16 two = look_up<3 * sizeof(float)>(strided.data(), b, b);
  std::array<int, f64x8_size> back;
  to_whole(2.0 * one, back);
  for (std::size_t l = 0; l < f64x8_size; ++l) {
    EXPECT_EQ(one[l], 0.5 * a[l]);
    EXPECT_EQ(two[l], 1.5F * float(b[l]));
    EXPECT_EQ(two[f64x8_size + l], two[l]);
    EXPECT_EQ(back[l], a[l]);
  }
}

// The whole number between two goes to the even one.
TEST(LaneFunctions, FloorAndNearest) {
  const f64x8 x = {-2.0, -1.5, -0.1, 0.0, 0.5, 1.0, 2.5, 1e6 + 0.5}, f = floor(x), n = nearest(x);
  const f32x16 y = to_single(x, -x), g = floor(y), m = nearest(y);
  for (std::size_t l = 0; l < f64x8_size; ++l) {
    EXPECT_EQ(f[l], std::floor(x[l]));
    EXPECT_EQ(n[l], std::nearbyint(x[l]));
    for (const std::size_t k : {l, l + f64x8_size}) {
      EXPECT_EQ(g[k], std::floor(y[k]));
      EXPECT_EQ(m[k], std::nearbyint(y[k]));
    }
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
    const f32x16 rates = to_single(gamma, gamma), yields = to_single(tau_y, tau_y);
    const f64x8 c = to_double(secant(smooth, rates, yields), 1),
                d = to_double(secant(broken, rates, yields), 1);
    for (int l = 0; l < f64x8_size; ++l) {
      EXPECT_NEAR(c[l] / a[l], 1.0, 1e-6);  // five units in the last place, and the arguments' rounding
      EXPECT_NEAR(d[l] / b[l], 1.0, 1e-6);
    }
  }
}

// Both kinetics at rates on either side of the gate and across it.
TEST(LaneLaws, FlocculationAsTheScalarUpdate) {
  std::mt19937 random(3);
  for (const Kinetics kinetics : {Kinetics::gated, Kinetics::roussel})
    for (int i = 0; i < 500; ++i) {
      const Thixotropy t{1.3, 0.03, kinetics, 0.1, 0.0};
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
    Weights<2> weights;
    weigh<2>(axes, shape, {tile, 0}, x, weights);
    for (int d = 0; d < 2; ++d)
      for (int l = 0; l < f64x8_size; ++l) {
        const int base = d == 0 ? weights.base[static_cast<std::size_t>(l)] / tile_span
                                : weights.base[static_cast<std::size_t>(l)] % tile_span;
        double one = 0.0, place = 0.0, flat = 0.0, slope = 0.0;
        for (int k = 0; k < 3; ++k) {
          const double at = shape.node_position(axes[d], (d == 0 ? tile : 0) * tile_cells - 1 + base + k);
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

// Two points whose weights come from the factored sums see a quadratic field's values and slopes as the plain
// sum over 27 nodes does.
TEST(FactoredSums, GatherAndScatterAreAdjoint) {
  constexpr int D = 3;
  std::array<Axis, D> axes;
  for (Axis& a : axes) a = {.h = 0.1};
  std::mt19937 random(6);
  Weights<D> weights;
  const std::array<f64x8, D> x = {random_lanes(random, 0.0, 0.4), random_lanes(random, 0.0, 0.4),
                                  random_lanes(random, 0.0, 0.4)};
  weigh<D>(axes, {}, {0, 0, 0}, x, weights);
  std::array<f64x4, TileGrid<D>::tile_nodes> v, sums{};
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (f64x4& node : v) node = f64x4{u(random), u(random), u(random), u(random)};
  const auto w = of_lane<D>(weights, 3);
  const auto got = gather<D, 3, slopes_and_moments>(&v[weights.base[3]], w);
  double value = 0.0, slope = 0.0, moment = 0.0;
  for (int i = 0; i < 27; ++i) {
    const Index<D> o = local_offset<D>(i);
    const double n = v[weights.base[3] + o[0] * 64 + o[1] * 8 + o[2]][1];
    value += w.w[0][o[0]] * w.w[1][o[1]] * w.w[2][o[2]] * n;
    slope += w.w[0][o[0]] * w.dw[1][o[1]] * w.w[2][o[2]] * n;
    moment += w.w[0][o[0]] * w.w[1][o[1]] * w.wa[2][o[2]] * n;
  }
  EXPECT_NEAR(got.value[1], value, 1e-14);
  EXPECT_NEAR(got.slope[1][1], slope, 1e-12);
  EXPECT_NEAR(got.moment[2][1], moment, 1e-15);

  f64x4 P = {1.0, -2.0, 0.5, 3.0}, S[D] = {P * 0.1, P * 0.2, P * 0.3}, Q[D] = {P * 2.0, P, P * -1.0};
  scatter<D, 3>(&sums[weights.base[3]], w, P, S, Q);
  double left = 0.0, right = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i)
    for (int c = 0; c < 4; ++c) left += sums[i][c] * v[i][c];
  for (int c = 0; c < 4; ++c) {
    right += P[c] * got.value[c];
    for (int d = 0; d < D; ++d) right += S[d][c] * got.slope[d][c] + Q[d][c] * got.moment[d][c];
  }
  EXPECT_NEAR(left, right, 1e-12);
}

/// Eight points in neighbouring cells, or all in one, next to a wall or not, and what a tile's nodes
/// carry.
struct EightPoints {
  static constexpr int D = 3;
  Weights<D> weights;
  TileGrid<D>::Buffer v;
  Spread<D> spread;

  EightPoints(bool together, ShapeFunctions kind = ShapeFunctions::b_spline, bool at_wall = false) {
    std::array<Axis, D> axes;
    for (Axis& a : axes) a = {.h = 0.1, .low = at_wall ? FaceKind::no_slip : FaceKind::open};
    Shape<D> shape{kind, {}};
    shape.half.fill(0.25);
    std::mt19937 random(7);
    // GIMP's stencils go by the nearest corner.
    const double low = at_wall ? 0.0 : kind == ShapeFunctions::gimp ? 0.151 : 0.2;
    const double high = low + (together ? at_wall && kind == ShapeFunctions::gimp ? 0.049 : 0.098 : 0.2);
    const std::array<f64x8, D> x = {random_lanes(random, low, high), random_lanes(random, low, high),
                                    random_lanes(random, low, high)};
    weigh<D>(axes, shape, {0, 0, 0}, x, weights);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (f64x4& node : v) node = f64x4{u(random), u(random), u(random), u(random)};
    for (f64x8& value : spread.value) value = random_lanes(random, -1.0, 1.0);
    for (int d = 0; d < D; ++d)
      for (int c = 0; c < D; ++c)
        spread.slope[d][c] = random_lanes(random, -0.1, 0.1),
        spread.moment[d][c] = random_lanes(random, -9.0, 9.0);
  }
};

// What is read side by side, and what is added for eight points at once, is what each of the eight alone
// would read and add, to round-off: in one cell and in several.
TEST(GroupSums, AsPointByPoint) {
  constexpr int D = 3;
  for (const auto& [together, kind, at_wall] : {std::tuple{true, ShapeFunctions::b_spline, false},
                                                {false, ShapeFunctions::b_spline, false},
                                                {true, ShapeFunctions::b_spline, true},
                                                {true, ShapeFunctions::gimp, false},
                                                {true, ShapeFunctions::gimp, true}}) {
    EightPoints eight(together, kind, at_wall);
    EXPECT_EQ(eight.weights.together, together);
    TileGrid<D>::Buffer got{}, expected{};
    scatter_group<D, Given{}>(eight.weights, eight.spread, f64x8_size, got.data());
    for (int l = 0; l < f64x8_size; ++l) {
      const auto w = of_lane<D>(eight.weights, l);
      const int base = eight.weights.base[static_cast<std::size_t>(l)];
      f64x4 value = {}, slope[D] = {}, moment[D] = {};
      for (int c = 0; c < 4; ++c) value[c] = eight.spread.value[c][l];
      for (int d = 0; d < D; ++d)
        for (int c = 0; c < D; ++c)
          slope[d][c] = eight.spread.slope[d][c][l], moment[d][c] = eight.spread.moment[d][c][l];
      scatter<D, 3>(&expected[base], w, value, slope, moment);
      if (!together) continue;
      const auto one = gather<D, 3, slopes_and_moments>(&eight.v[base], w);
      for (int c = 0; c < D; ++c) {
        const auto all = gather_together<D, slopes_and_moments>(&eight.v[base], c, eight.weights);
        EXPECT_NEAR(all.value[l], one.value[c], 1e-14);
        for (int d = 0; d < D; ++d) {
          EXPECT_NEAR(all.slope[d][l], one.slope[d][c], 1e-12);
          EXPECT_NEAR(all.moment[d][l], one.moment[d][c], 1e-15);
        }
      }
    }
    for (std::size_t i = 0; i < got.size(); ++i)
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(got[i][c], expected[i][c], 1e-13);
  }
}

// Rows to columns and back; the first lane of each row is a component.
TEST(GroupSums, RowsAndColumns) {
  f64x4 rows[f64x8_size], back[f64x8_size];
  for (int l = 0; l < f64x8_size; ++l)
    for (int c = 0; c < 4; ++c) rows[l][c] = 10 * l + c;
  f64x8 columns[4];
  to_columns(rows, columns);
  to_rows(columns, back);
  for (int l = 0; l < f64x8_size; ++l)
    for (int c = 0; c < 4; ++c) {
      EXPECT_EQ(columns[c][l], rows[l][c]);
      EXPECT_EQ(back[l][c], rows[l][c]);
    }
}

// Sorted points are all there once, in tiles in their order; groups of one cell's points come first, and only
// the groups counted as mixed hold points of several cells.
TEST(SortedPoints, GroupsOfOneCell) {
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
  const auto sorted = sort_into_tiles<D>(axes, 0.0, lanes);
  std::vector<int> seen(points.size(), 0);
  std::int64_t mixed = 0;
  for (std::size_t t = 0; t < sorted.tiles.size(); ++t) {
    const Tile<D>& tile = sorted.tiles[t];
    if (t > 0) {
      EXPECT_LT(sorted.tiles[t - 1].at, tile.at);
    }
    for (int g = tile.first_group; g < tile.last_group; ++g) {
      std::set<Index<D>> cells;
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
        cells.insert(cell);
      }
      mixed += cells.size() > 1 ? 1 : 0;
    }
  }
  for (const int n : seen) EXPECT_EQ(n, 1);
  EXPECT_GT(mixed, 0);
  EXPECT_LE(mixed, sorted.mixed);
}

}  // namespace
}  // namespace tremie
