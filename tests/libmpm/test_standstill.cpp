// What stands must not move: weights that the pressures of the cells balance, and a body below its yield stress.

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstdio>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/problem/cell_weights.hpp"
#include "libmpm/implicit/steady/foot.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie {
namespace {

using namespace bodies;

constexpr double rho = 2400.0, g = 9.81, h = 0.01;

/// A layer six and a half cells deep between walls that slip, under its own pressure: with its surface in the middle of a cell.
template <class Geometry>
ImplicitBody<Geometry> layer(double tau_0) {
  ImplicitBody<Geometry> body;
  body.mix = concrete(tau_0, 30.0);
  body.gravity = {0.0, -g};
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 6};
  body.grid.axes[1] = {.h = h, .low = FaceKind::no_slip};
  fill_box<Geometry>(body, {0.0, 0.0}, {6 * h, 6.5 * h}, 4,
                     [](const Vec<2>& x) { return rho * g * (6.5 * h - x[1]); });
  return body;
}

/// The largest speed of a Newtonian layer after a second.
template <class Geometry>
double speed_of_layer(bool balanced) {
  omp_set_num_threads(1);
  auto body = layer<Geometry>(0.0);
  StepSettings settings;
  settings.weight = balanced ? WeightRule::balanced : WeightRule::points;
  settings.cut_cell_rule = balanced;
  StepReport step;
  while (body.time < 1.0) step = implicit_step(body, ExactBingham{}, settings);
  return step.max_speed;
}

template <class Geometry>
class Sections : public testing::Test {};
using SectionTypes = testing::Types<Axisymmetric, PlaneStrain>;
TYPED_TEST_SUITE(Sections, SectionTypes);

// A fluid without a yield stress is held by the balance of forces alone. One pressure a cell leaves a weight of up to rho g h/3 to
// the stresses, and the layer moves by some 1e-4 m/s; a pressure that falls with height within the cells leaves rounding.
TYPED_TEST(Sections, BalancedWeightsLeaveAFluidAtRest) {
  const double balanced = speed_of_layer<TypeParam>(true), counted = speed_of_layer<TypeParam>(false);
  std::printf("a Newtonian layer at rest: %.1e m/s, balanced %.1e m/s\n", counted, balanced);
  EXPECT_GT(counted, 1e-6);
  EXPECT_LE(balanced, 1e-9);
}

// The weights add up to that of the mass.
TYPED_TEST(Sections, BalancedWeightsAreTheWeight) {
  auto body = layer<TypeParam>(0.0);
  activate(body.grid, body.points.x);
  lay_out_quadrature<TypeParam>(body.grid, body.points, body.mix.tau_0, body.mix.K, body.quadrature, true);
  Vec<2> sum = Vec<2>::Zero();
  for (const Vec<2>& force : balanced_weights(body.grid, body.points, body.quadrature, body.gravity, false))
    sum += force;
  EXPECT_NEAR(sum[1] / (-g * total_mass(body.points)), 1.0, 1e-9);
}

// Concrete in a pot is below its yield stress once it is at rest. From then on nothing moves, and lambda gains A_thix/tau_0 a
// second. A fluid never is, nor a law that flows at all stresses.
TEST(Standstill, OnlyStructureChanges) {
  omp_set_num_threads(1);
  auto body = layer<PlaneStrain>(50.0);
  body.mix.thixotropy = Thixotropy{0.5, RatePowerKinetics{0.334, 0.1}};
  experiment::rest(body, 0.0);
  StepSettings settings;
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  EXPECT_TRUE(is_below_yield(body, ExactBingham{}, 1e-3));
  EXPECT_FALSE(is_below_yield(body, Papanastasiou{100.0}, 1e-3));
  const Points<2> before = body.points;
  const double from = body.time;
  for (const double dt : {2.0, 100.0, 498.0}) EXPECT_EQ(stand_still(dt, body).dt, dt);
  EXPECT_NEAR(body.time - from, 600.0, 1e-9);
  EXPECT_EQ(body.points.x, before.x);
  EXPECT_EQ(body.points.ln_J, before.ln_J);
  for (std::size_t p = 0; p < before.size(); ++p)
    EXPECT_NEAR(body.points.lambda[p] - before.lambda[p], 0.5 * 600.0 / 50.0, 1e-9);

  auto fluid = layer<PlaneStrain>(0.0);
  fluid.points.v.assign(fluid.points.size(), Vec<2>(0.0, -0.01));
  implicit_step(fluid, ExactBingham{}, settings);
  EXPECT_FALSE(is_below_yield(fluid, ExactBingham{}, 1e-3));
}

/// Concrete 24 cells deep at the left and 18 at the right, whose surface levels out between walls that slip.
ImplicitBody<PlaneStrain> slope() {
  ImplicitBody<PlaneStrain> body;
  body.mix = concrete(25.0, 30.0);
  body.mix.thixotropy = Thixotropy{0.5, RatePowerKinetics{0.334, 0.1}};
  body.gravity = {0.0, -g};
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 12};
  body.grid.axes[1] = {.h = h, .low = FaceKind::no_slip};
  const auto surface = [](double x) { return 24 * h - 0.5 * x; };
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {12 * h, 24 * h}, {24, 48}, rho, body.mix.K,
      [&](const Vec<2>& x) { return x[1] < surface(x[0]); },
      [&](const Vec<2>& x) { return rho * g * (surface(x[0]) - x[1]); }, body.points);
  experiment::rest(body, 0.0);
  return body;
}

/// Mean height of the points within three cells of a place.
double height_at(const ImplicitBody<PlaneStrain>& body, double from) {
  double sum = 0.0, mass = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    if (body.points.x[p][0] > from && body.points.x[p][0] < from + 3 * h)
      sum += body.points.mass[p] * body.points.x[p][1], mass += body.points.mass[p];
  return sum / mass;
}

// A slope levels out the same on its whole bed and on a floor that has risen to where the concrete rests: to 2 % of how far it
// sinks. What stands aside keeps its place and gains A_thix/tau_0 a second and the pressure of the weight that
// is added above it; nothing is lost on the way there and back.
TEST(Foot, IsLeftOut) {
  omp_set_num_threads(1);
  auto whole = slope(), cut = slope();
  StepSettings settings;
  Foot<2> foot;
  const double mass = total_mass(cut.points), before = height_at(whole, 0.0);
  while (whole.time < 0.3) implicit_step(whole, ExactBingham{}, settings);
  while (cut.time < 0.3) implicit_step(cut, ExactBingham{}, settings);
  const int layers = resting_layers(cut, ExactBingham{});
  std::printf("layers at rest: %d\n", layers);
  ASSERT_GE(layers, 5);
  EXPECT_EQ(resting_layers(cut, Papanastasiou{100.0}), 0);
  EXPECT_EQ(set_aside(layers, cut, foot).size(), foot.points.size() + cut.points.size());
  const Points<2> stands = foot.points;
  const double from = cut.time;
  while (whole.time < 2.0) implicit_step(whole, ExactBingham{}, settings);
  while (cut.time < 2.0) wait(implicit_step(cut, ExactBingham{}, settings).dt, 0.0, cut, foot);
  wait(0.0, 1000.0, cut, foot);
  for (std::size_t p = 0; p < stands.size(); ++p) {
    EXPECT_EQ(foot.points.x[p], stands.x[p]);
    EXPECT_NEAR(foot.points.lambda[p] - stands.lambda[p], 0.5 * (cut.time - from) / 25.0, 1e-9);
    EXPECT_NEAR(cut.mix.K * (stands.ln_J[p] - foot.points.ln_J[p]), 1000.0, 1e-6);
  }
  take_back(cut, foot);
  EXPECT_EQ(foot.points.size(), 0u);
  EXPECT_EQ(cut.grid.axes[1].origin, 0.0);
  EXPECT_NEAR(total_mass(cut.points) / mass, 1.0, 1e-12);
  const double sunk = before - height_at(whole, 0.0), apart = height_at(cut, 0.0) - height_at(whole, 0.0);
  std::printf("sunk by %.2f mm, %.3f mm apart\n", 1e3 * sunk, 1e3 * apart);
  EXPECT_GT(sunk, 0.2 * h);
  EXPECT_LE(std::abs(apart), 0.02 * sunk);
}

}  // namespace
}  // namespace tremie
