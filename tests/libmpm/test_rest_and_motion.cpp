// Verification case 3: bodies at rest and in rigid motion, in the three spaces.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/detached_particles.hpp"
#include "libmpm/implicit/step_size.hpp"

namespace tremie {
namespace {

using namespace bodies;

constexpr double rho = 2400.0, g = 9.81, height = 0.3;

/// A column of concrete, `levels` cells high, on a floor between free-slip walls; `hydrostatic`: it starts
/// under its own weight, otherwise without pressure.
template <class Geometry>
ImplicitBody<Geometry> column(int levels, int across, bool hydrostatic, double tau_0) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  ImplicitBody<Geometry> body;
  body.mix = concrete(tau_0, 35.8);
  body.gravity[up] = -g;
  const double h = height / levels;
  Vec<D> low = Vec<D>::Zero(), high = Vec<D>::Constant(across * h);
  for (Axis& a : body.grid.axes)
    a = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = across};
  body.grid.axes[up] = {.h = h, .low = FaceKind::no_slip};
  high[up] = height;
  fill_box<Geometry>(body, low, high, 2,
                     [&](const auto& x) { return hydrostatic ? rho * g * (height - x[up]) : 0.0; });
  return body;
}

/// Largest error of the pressure in a point, in units of rho g H, for a surface at `top`.
template <class Geometry>
double worst_pressure(const ImplicitBody<Geometry>& body, double top) {
  double worst = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const double head = pressure(body.points.ln_J[p], body.mix.K) / (rho * g);
    worst = std::max(worst, std::abs(head - (top - body.points.x[p][Geometry::up])) / height);
  }
  return worst;
}

template <class Geometry>
class AllSpaces : public testing::Test {
 protected:
  void SetUp() override { omp_set_num_threads(1); }
};
using SpaceTypes = testing::Types<Axisymmetric, PlaneStrain, ThreeD>;
TYPED_TEST_SUITE(AllSpaces, SpaceTypes);

// p = rho g (H - z) in every point within 1 % of rho g H after a second, and the concrete stands still. One
// pressure a cell with quadratic velocities balances a weight only up to a pressure of alternating sign, rho
// g h/6: 0.4 % of rho g H with 40 cells over the height.
TYPED_TEST(AllSpaces, HydrostaticStart) {
  auto body = column<TypeParam>(40, 2, true, 54.0);
  StepSettings settings;
  settings.dt_max = 0.05;
  settings.admm.direct_below = 1'000'000;  // the balance itself: by iteration, its tolerance leaves 4e-6 m/s
  while (body.time < 1.0) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  const double worst = worst_pressure(body, height), speed = detail::max_speed(body.points);
  std::printf("hydrostatic start: worst pressure error %.2e of rho g H, speed %.1e m/s\n", worst, speed);
  EXPECT_LE(worst, 0.01);
  EXPECT_LE(speed, 1e-6);
}

// Nothing holds a Newtonian fluid but the balance of forces itself.
TYPED_TEST(AllSpaces, HydrostaticStartNewtonian) {
  auto body = column<TypeParam>(40, 2, true, 0.0);
  StepSettings settings;
  settings.dt_max = 0.05;
  while (body.time < 1.0) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  const double worst = worst_pressure(body, height), speed = detail::max_speed(body.points);
  std::printf("hydrostatic start, Newtonian: worst pressure error %.2e of rho g H, speed %.1e m/s\n", worst,
              speed);
  EXPECT_LE(worst, 0.01);
}

// A uniform pressure in a closed box must not push anywhere, in rings near the axis least of all: speeds stay
// at round-off (the pressure would give the axis cell 1 m/s in 1e-3 s if 1 % of it were out of balance).
TYPED_TEST(AllSpaces, UniformPressureIsBalanced) {
  constexpr int D = TypeParam::dim;
  ImplicitBody<TypeParam> body;
  body.mix = concrete(0.0, 35.8);
  for (Axis& a : body.grid.axes)
    a = {.h = 0.05, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 4};
  fill_box(body, Vec<D>(Vec<D>::Zero()), Vec<D>(Vec<D>::Constant(0.2)), 2,
           [](const auto&) { return 7000.0; });
  StepSettings settings;
  settings.fixed_dt = 1e-3;
  for (int i = 0; i < 3; ++i) implicit_step(body, ExactBingham{}, settings);
  EXPECT_LE(detail::max_speed(body.points), 1e-10);
}

// Weight put on a body without pressure: it sinks, rings down, and ends under rho g (H - z). Every point of a
// cell takes the cell's change of volume: its pressure is its cell's, a quarter of a cell of head off at two
// points a cell.
TEST(Rest, PressureFromNothing) {
  omp_set_num_threads(1);
  auto body = column<PlaneStrain>(120, 2, false, 0.0);
  StepSettings settings;
  settings.dt_max = 0.02;
  while (body.time < 2.0) implicit_step(body, ExactBingham{}, settings);
  const double sunk = 0.5 * rho * g * height * height / body.mix.K;
  const double worst = worst_pressure(body, height - sunk);
  std::printf("settled from zero pressure: worst pressure error %.2e of rho g H\n", worst);
  EXPECT_LE(worst, 0.01);
}

// Free fall: v = g t and, by backward Euler, z = -g t (t + dt)/2 exactly; nothing deforms, mass stays to the
// bit.
TYPED_TEST(AllSpaces, FreeFall) {
  constexpr int D = TypeParam::dim, up = TypeParam::up;
  ImplicitBody<TypeParam> body;
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
  ImplicitBody<TypeParam> body;
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
template <class Geometry>
ImplicitBody<Geometry> rotating(const Eigen::Vector3d& omega, double h, int per_cell) {
  constexpr int D = Geometry::dim;
  ImplicitBody<Geometry> body;
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

/// Angular momentum over `steps` steps of 1 ms, relative to its start. Transfer and forces keep it to
/// round-off. Points that are moved to even out the fill of cells carry their momentum elsewhere: with it on,
/// 1e-5 is allowed.
template <class Geometry>
void expect_angular_momentum_kept(ImplicitBody<Geometry> body, int steps, bool particle_shifting,
                                  double tolerance) {
  omp_set_num_threads(1);
  const auto start = angular_momentum<Geometry::dim>(body);
  StepSettings settings;
  settings.fixed_dt = 1e-3;
  settings.particle_shifting.on = particle_shifting;
  int unconverged = 0;
  for (int i = 0; i < steps; ++i) unconverged += !implicit_step(body, ExactBingham{}, settings).converged;
  EXPECT_EQ(unconverged, 0);
  const double drift = (angular_momentum<Geometry::dim>(body) - start).norm() / start.norm();
  std::printf("angular momentum after %d steps: relative drift %.2g\n", steps, drift);
  EXPECT_LE(drift, tolerance);
  EXPECT_LE(momentum(body.points).norm(), tolerance * start.norm());
}

TEST(Rotation, AngularMomentumInThePlane) {
  expect_angular_momentum_kept(rotating<PlaneStrain>({0, 0, 2.0}, 0.05, 2), 1000, false, 1e-10);
}
TEST(Rotation, AngularMomentumWhileCellsAreEvenedOut) {
  expect_angular_momentum_kept(rotating<PlaneStrain>({0, 0, 2.0}, 0.05, 2), 1000, true, 1e-5);
}
TEST(Rotation, AngularMomentumIn3D) {
  expect_angular_momentum_kept(rotating<ThreeD>({0.5, -1.0, 1.5}, 0.1, 2), 1000, false, 1e-10);
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

// Across a periodic seam: a chunk of concrete that fills the period slides on with its speed, for one to five
// cells.
TEST(Periodic, UniformFlowWraps) {
  for (int n : {1, 2, 5}) {
    ImplicitBody<PlaneStrain> body;
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

/// Largest speed after a second of a Newtonian layer on a floor, half a cell short of whole cells [m/s].
template <class Geometry>
double speed_of_layer(double alternating_viscosity) {
  constexpr int up = Geometry::up;
  constexpr double h = 0.01;
  ImplicitBody<Geometry> body;
  body.mix = concrete(0.0, 30.0);
  body.gravity[up] = -9.81;
  for (int d = 0; d < up; ++d)
    body.grid.axes[d] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 6};
  body.grid.axes[up] = {.h = h, .low = FaceKind::no_slip};
  Vec<Geometry::dim> high = Vec<Geometry::dim>::Constant(6.0 * h);
  high[up] = 6.5 * h;
  fill_box(body, Vec<Geometry::dim>(Vec<Geometry::dim>::Zero()), high, 4,
           [&](const auto& x) { return 2400.0 * 9.81 * (6.5 * h - x[up]); });
  StepSettings settings;
  settings.admm.direct_below = 0;  // in 3D by iteration
  settings.alternating_viscosity = alternating_viscosity;
  StepReport step;
  while (body.time < 1.0) step = implicit_step(body, ExactBingham{}, settings);
  return step.max_speed;
}

// What is left of the layer's motion alternates from node to node for the most part. Its own viscosity takes that down, to less
// than half here: the surface cells, which are not full, still sag.
TEST(Rest, VelocitiesThatAlternateAreResisted) {
  const auto compare = [](const char* space, double freely, double resisted) {
    std::printf("a layer at rest, %s: %.2e m/s, resisted %.2e m/s\n", space, freely, resisted);
    EXPECT_LE(resisted, 0.5 * freely);
  };
  compare("plane", speed_of_layer<PlaneStrain>(0.0), speed_of_layer<PlaneStrain>(100.0));
  compare("3D", speed_of_layer<ThreeD>(0.0), speed_of_layer<ThreeD>(100.0));
}

// A drop that would fall ten cells in a step falls one and is slowed to it; who moves less is left alone.
TEST(Motion, StraysAreHeld) {
  Points<2> points;
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {0.02, 0.01}, {2, 1}, 2400.0, 1e6, [](const auto&) { return true; },
      [](const auto&) { return 0.0; }, points);
  points.v = {{0.0, -1.0}, {0.03, -0.05}};
  const auto before = points.x;
  for (std::size_t p = 0; p < 2; ++p) points.x[p] += 0.1 * points.v[p];
  const auto moved = points.x;
  hold_detached_particles<2>({Axis{.h = 0.01}, Axis{.h = 0.01}}, 0.1, before, points);
  EXPECT_NEAR(points.x[0][1], before[0][1] - 0.01, 1e-15);
  EXPECT_NEAR(points.v[0][1], -0.1, 1e-15);
  EXPECT_EQ(points.x[1], moved[1]);
}

// A drop that the floor stopped after half a cell stays there. Taking back its speed times the step threw it up by nine cells,
// where it fell again, for good: drops of an L-box at rest hung 883 mm above its floor.
TEST(Motion, AStrayThatTheFloorStoppedIsNotThrownUp) {
  Points<2> points;
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {0.01, 0.01}, {1, 1}, 2400.0, 1e6, [](const auto&) { return true; },
      [](const auto&) { return 0.0; }, points);
  points.v = {{0.0, -1.0}};
  const auto before = points.x;
  points.x[0][1] = 0.0;
  hold_detached_particles<2>({Axis{.h = 0.01}, Axis{.h = 0.01}}, 0.1, before, points);
  EXPECT_EQ(points.x[0][1], 0.0);
  EXPECT_NEAR(points.v[0][1], -0.1, 1e-15);
}

}  // namespace
}  // namespace tremie
