// What stands must not move: weights that the pressures of the cells balance, and a body below its yield stress.

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <cstdio>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/problem/cell_weights.hpp"
#include "libmpm/implicit/steady/standstill.hpp"

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
  settings.balanced_weight = settings.cut_cell_rule = balanced;
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
  for (const Vec<2>& force : balanced_weights(body.grid, body.points, body.quadrature, body.gravity))
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

}  // namespace
}  // namespace tremie
