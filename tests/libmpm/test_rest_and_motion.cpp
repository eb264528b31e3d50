// Rung 3: bodies at rest and in rigid motion, in the three spaces.

#include <gtest/gtest.h>
#include <omp.h>

#include "tests/libmpm/bodies.hpp"

namespace tremie {
namespace {

using namespace test;

constexpr double rho = 2400.0, g = 9.81;

/// A box of concrete, height H, on a floor between free-slip walls; `hydrostatic`: it starts under its own
/// weight.
template <class Space>
Body<Space> standing_box(double h, double H, bool hydrostatic, const Mix& mix) {
  constexpr int D = Space::dim, up = Space::up;
  Body<Space> body;
  body.mix = mix;
  body.gravity[up] = -g;
  Vec<D> low = Vec<D>::Zero(), high;
  for (int d = 0; d < D; ++d) {
    body.grid.axes[d] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 4};
    high[d] = 4 * h;
  }
  body.grid.axes[up] = {.h = h, .low = FaceKind::no_slip};
  high[up] = H;
  fill_box<Space>(body, low, high, 2,
                  [&](const auto& x) { return hydrostatic ? rho * g * (H - x[up]) : 0.0; });
  return body;
}

/// Largest error of the pressure in a point, in units of rho g H. One pressure a cell is what the scheme has,
/// so the law is met where its mean lives: the depth of the cell's points, half a cell at most from the
/// point's own.
template <class Space>
double worst_pressure(const Body<Space>& body, double H) {
  double worst = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    worst = std::max(worst, std::abs(pressure(body.points.ln_J[p], body.mix.K) / (rho * g) -
                                     (H - body.points.x[p][Space::up])) /
                                H);
  return worst;
}

template <class Space>
class AllSpaces : public testing::Test {
 protected:
  void SetUp() override { omp_set_num_threads(1); }
};
using SpaceTypes = testing::Types<Axisymmetric, PlaneStrain, ThreeD>;
TYPED_TEST_SUITE(AllSpaces, SpaceTypes);

// p = rho g (H - z) in every point within 1 % of rho g H, from a start under that pressure, for concrete with
// a yield stress and for a Newtonian fluid, after a second; and it stands still.
TYPED_TEST(AllSpaces, HydrostaticStart) {
  const double H = 0.3, h = 0.05;
  for (double tau_0 : {0.0, 54.0}) {
    auto body = standing_box<TypeParam>(h, H, true, concrete(tau_0, 35.8));
    StepSettings settings;
    settings.dt_max = 0.05;
    for (int i = 0; body.time < 1.0 && i < 500; ++i)
      EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
    const double worst = worst_pressure(body, H);
    std::printf("hydrostatic start, tau_0 %g: worst pressure error %.3g of rho g H\n", tau_0, worst);
    EXPECT_LE(worst, 0.01);
    EXPECT_LE(detail::max_speed(body.points), 1e-3);
  }
}

// Weight put on a body without pressure: it sinks by its compression, rings down, and ends under rho g (H -
// z). Every point of a cell takes the cell's change of volume, so its pressure is the cell's: half a cell of
// head off at the cell's edges. With 40 cells over the height that is 1.25 % of rho g H at most between
// points and 1 % is met at the points.
TEST(Rest, PressureFromNothing) {
  omp_set_num_threads(1);
  const double h = 0.0075, H = 0.3;
  auto body = standing_box<PlaneStrain>(h, H, false, concrete(0.0, 35.8));
  StepSettings settings;
  settings.dt_max = 0.02;
  for (int i = 0; body.time < 2.0 && i < 1000; ++i) implicit_step(body, ExactBingham{}, settings);
  const double sunk = 0.5 * rho * g * H * H / body.mix.K;
  const double worst = worst_pressure(body, H - sunk);
  std::printf("settled from zero pressure: worst pressure error %.3g of rho g H\n", worst);
  EXPECT_LE(worst, 0.01);
}

// Free fall: v = g t and, by backward Euler, z = -g t (t + dt)/2 exactly; nothing deforms, mass stays to the
// bit.
TYPED_TEST(AllSpaces, FreeFall) {
  constexpr int D = TypeParam::dim, up = TypeParam::up;
  Body<TypeParam> body;
  body.mix = concrete(54.0, 35.8);
  body.gravity[up] = -g;
  for (Axis& a : body.grid.axes) a.h = 0.05;
  Vec<D> low = Vec<D>::Zero(), high = Vec<D>::Constant(0.1);
  if (std::is_same_v<TypeParam, Axisymmetric>) body.grid.axes[0].low = FaceKind::free_slip;
  fill_box(body, low, high, 2);
  const Points<D> start = body.points;
  StepSettings settings;
  settings.fixed_dt = 0.01;
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  for (std::size_t p = 0; p < start.size(); ++p) {
    Vec<D> v = Vec<D>::Zero(), x = start.x[p];
    v[up] = -g * 0.5, x[up] -= g * 0.5 * 0.51 / 2;
    EXPECT_LE((body.points.v[p] - v).norm(), 1e-10 * 0.5 * g);
    EXPECT_LE((body.points.x[p] - x).norm(), 1e-10);
    EXPECT_LE(std::abs(body.points.ln_J[p]), 1e-11);
  }
  EXPECT_EQ(total_mass(body.points), total_mass(start));
}

// A body thrown through the grid keeps its shape and its momentum to round-off.
TYPED_TEST(AllSpaces, Translation) {
  constexpr int D = TypeParam::dim;
  Body<TypeParam> body;
  body.mix = concrete(54.0, 35.8);
  for (Axis& a : body.grid.axes) a.h = 0.05;
  Vec<D> v = Vec<D>::Constant(0.7);
  v[D - 1] = -0.9;
  if (std::is_same_v<TypeParam, Axisymmetric>) v[0] = 0.0, body.grid.axes[0].low = FaceKind::free_slip;
  fill_box(body, Vec<D>(Vec<D>::Zero()), Vec<D>(Vec<D>::Constant(0.1)), 3);
  body.points.v.assign(body.points.size(), v);
  const Points<D> start = body.points;
  StepSettings settings;
  settings.fixed_dt = 0.013;
  for (int i = 0; i < 60; ++i) implicit_step(body, ExactBingham{}, settings);
  for (std::size_t p = 0; p < start.size(); ++p)
    EXPECT_LE((body.points.x[p] - start.x[p] - 60 * 0.013 * v).norm(), 1e-10);
  EXPECT_LE((momentum(body.points) - momentum(start)).norm(), 1e-12 * momentum(start).norm());
}

/// A rotating body far from walls, without gravity.
template <class Space>
Body<Space> rotating(const Eigen::Vector3d& omega, double h, int per_cell) {
  constexpr int D = Space::dim;
  Body<Space> body;
  body.mix = concrete(54.0, 35.8);
  for (Axis& a : body.grid.axes) a.h = h;
  fill_box(body, Vec<D>(Vec<D>::Constant(-0.1)), Vec<D>(Vec<D>::Constant(0.1)), per_cell);
  Eigen::Matrix3d W;
  W << 0, -omega[2], omega[1], omega[2], 0, -omega[0], -omega[1], omega[0], 0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    body.points.C[p] = W.topLeftCorner<D, D>();
    body.points.v[p] = W.topLeftCorner<D, D>() * body.points.x[p];
  }
  return body;
}

/// Angular momentum over `steps` steps, relative to its start; 1e-10 is round-off added up, steps of 1 ms.
template <class Space>
void expect_angular_momentum_kept(Body<Space> body, int steps) {
  omp_set_num_threads(1);
  const auto start = angular_momentum<Space::dim>(body);
  StepSettings settings;
  settings.fixed_dt = 1e-3;
  int unconverged = 0;
  for (int i = 0; i < steps; ++i) unconverged += !implicit_step(body, ExactBingham{}, settings).converged;
  EXPECT_EQ(unconverged, 0);
  const double drift = (angular_momentum<Space::dim>(body) - start).norm() / start.norm();
  std::printf("angular momentum after %d steps: relative drift %.2g\n", steps, drift);
  EXPECT_LE(drift, 1e-10);
  EXPECT_LE(momentum(body.points).norm(), 1e-10 * start.norm());
}

TEST(Rotation, AngularMomentumInThePlane) {
  expect_angular_momentum_kept(rotating<PlaneStrain>({0, 0, 2.0}, 0.05, 2), 1000);
}
TEST(Rotation, AngularMomentumIn3D) {
  expect_angular_momentum_kept(rotating<ThreeD>({0.5, -1.0, 1.5}, 0.1, 2), 1000);
}

// A rigid rotation stays one: after one radian the body has turned by one radian. Backward Euler moves a
// point along its tangent, so radii grow by sqrt(1 + (omega dt)^2) a step: 0.05 % over the radian at omega dt
// = 1e-3; 0.2 % are allowed.
TEST(Rotation, StaysRigid) {
  omp_set_num_threads(1);
  auto body = rotating<PlaneStrain>({0, 0, 1.0}, 0.05, 2);
  const auto start = body.points;
  StepSettings settings;
  settings.fixed_dt = 1e-3;
  for (int i = 0; i < 1000; ++i) implicit_step(body, ExactBingham{}, settings);
  const Eigen::Rotation2Dd turn(1.0);
  double worst = 0.0;
  for (std::size_t p = 0; p < start.size(); ++p)
    worst = std::max(worst, (body.points.x[p] - turn * start.x[p]).norm() / start.x[p].norm());
  std::printf("rigid rotation by one radian: worst displacement error %.2g\n", worst);
  EXPECT_LE(worst, 2e-3);
}

// Across a periodic seam: a strip of concrete that fills the period slides on with its speed, for one to five
// cells.
TEST(Periodic, UniformFlowWraps) {
  for (int n : {1, 2, 5}) {
    Body<PlaneStrain> body;
    body.mix = concrete(54.0, 35.8);
    body.grid.axes[0] = {.h = 0.05, .periodic = true, .n_cells = n};
    body.grid.axes[1] = {.h = 0.05, .low = FaceKind::free_slip};
    fill_box(body, {0.0, 0.0}, {0.05 * n, 0.1}, 2);
    body.points.v.assign(body.points.size(), Vec<2>(0.6, 0.0));
    const auto start = body.points;
    StepSettings settings;
    settings.fixed_dt = 0.02;
    for (int i = 0; i < 50; ++i) EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
    for (std::size_t p = 0; p < start.size(); ++p) {
      const double moved = (body.points.x[p][0] - start.x[p][0] - 0.6) / (0.05 * n);
      EXPECT_NEAR(moved, std::round(moved), 1e-9);
      EXPECT_NEAR(body.points.v[p][0], 0.6, 1e-12);
      EXPECT_NEAR(body.points.x[p][1], start.x[p][1], 1e-12);
    }
  }
}

}  // namespace
}  // namespace tremie
