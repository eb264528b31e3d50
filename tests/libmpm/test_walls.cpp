// Coulomb's floor and moving rigid walls, on blocks too stiff to flow.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"

namespace tremie {
namespace {

using namespace bodies;

constexpr double coefficient = 0.4, g = 9.81;

/// A block 0.2 m long and 0.1 m high with a yield stress of twenty times its weight, on a floor with friction
/// in a gravity field tilted by theta.
ImplicitBody<PlaneStrain> block_on_a_slope(double theta) {
  ImplicitBody<PlaneStrain> body;
  body.mix = concrete(5e4, 100.0);
  body.gravity = {g * std::sin(theta), -g * std::cos(theta)};
  body.grid.axes[0] = {.h = 0.025};
  body.grid.axes[1] = {.h = 0.025, .low = FaceKind::wall_law};
  fill_box(body, {0.0, 0.0}, {0.2, 0.1}, 2,
           [&](const auto& x) { return 2400.0 * g * std::cos(theta) * (0.1 - x[1]); });
  return body;
}

/// Speed of the centre of mass along the slope after half a second.
double speed_on_a_slope(double theta, YieldMethod method) {
  omp_set_num_threads(1);
  auto body = block_on_a_slope(theta);
  StepSettings settings;
  settings.method = method;
  settings.wall_law = Coulomb{coefficient};
  settings.fixed_dt = 0.01;
  int unconverged = 0;
  for (int i = 0; i < 50; ++i) unconverged += !implicit_step(body, ExactBingham{}, settings).converged;
  EXPECT_EQ(unconverged, 0);
  return momentum(body.points)[0] / total_mass(body.points);
}

class Friction : public testing::TestWithParam<YieldMethod> {};

// Below tan theta = 0.4 (21.8 degrees) the block stays: no more than 0.1 % of the speed that it would have
// without floor.
TEST_P(Friction, SticksOnAGentleSlope) {
  for (double degrees : {5.0, 15.0, 20.0}) {
    const double theta = degrees * std::numbers::pi / 180.0, speed = speed_on_a_slope(theta, GetParam());
    std::printf("slope of %g degrees: %.2e m/s\n", degrees, speed);
    EXPECT_LE(std::abs(speed), 1e-3 * 0.5 * g * std::sin(theta));
  }
}

// Above it v = g (sin theta - 0.4 cos theta) t. 3 %: the normal forces are renewed until they change by less
// than 2 %.
TEST_P(Friction, SlidesOnASteepOne) {
  for (double degrees : {25.0, 30.0, 45.0}) {
    const double theta = degrees * std::numbers::pi / 180.0, speed = speed_on_a_slope(theta, GetParam());
    const double exact = 0.5 * g * (std::sin(theta) - coefficient * std::cos(theta));
    std::printf("slope of %g degrees: %.4f m/s, exact %.4f\n", degrees, speed, exact);
    EXPECT_NEAR(speed / exact, 1.0, 0.03);
  }
}
INSTANTIATE_TEST_SUITE_P(Methods, Friction, testing::Values(YieldMethod::admm, YieldMethod::newton));

// A wall that moves at 0.5 m/s for 0.2 s takes a block along at its own speed (1 %: a penalty holds them
// together), stops, and the block goes on by itself with all its momentum: walls push, they do not pull.
TEST(RigidWalls, PushAndSeparate) {
  omp_set_num_threads(1);
  ImplicitBody<PlaneStrain> body;
  body.mix = concrete(5e4, 100.0);
  body.grid.axes[0] = {.h = 0.025};
  body.grid.axes[1] = {.h = 0.025, .low = FaceKind::free_slip};
  fill_box(body, {0.0, 0.0}, {0.2, 0.1}, 2);
  const RigidWall<2> wall = [](const Vec<2>& x, double time) -> std::optional<WallView<2>> {
    const double place = 0.5 * std::min(time, 0.2), gap = x[0] - place;
    if (std::abs(gap) > 0.05) return std::nullopt;
    return WallView<2>{gap, Vec<2>(1.0, 0.0), Vec<2>(time <= 0.2 ? 0.5 : 0.0, 0.0)};
  };
  StepSettings settings;
  settings.fixed_dt = 0.005;
  settings.wall_gap = 0.25 * 0.025;
  const double mass = total_mass(body.points);
  while (body.time < 0.2 - 1e-9) implicit_step(body, ExactBingham{}, settings, wall);
  const double pushed = momentum(body.points)[0] / mass;
  std::printf("pushed at 0.5 m/s: block at %.4f m/s\n", pushed);
  // The penalty lets the wall come 3 % of a step too near at first; closing that gap throws the block ahead
  // by as much.
  EXPECT_GE(pushed, 0.495);
  EXPECT_LE(pushed, 0.52);
  double nearest = 1.0;
  for (const Vec<2>& x : body.points.x) nearest = std::min(nearest, x[0]);
  EXPECT_GE(nearest, 0.1 + 0.9 * settings.wall_gap);
  while (body.time < 0.6) implicit_step(body, ExactBingham{}, settings, wall);
  EXPECT_NEAR(momentum(body.points)[0] / mass / pushed, 1.0, 1e-9);
}

/// One point of 10 mm under the pressure p, `gap` from a wall at x = 0.1 that goes along itself as fast as a cone is lifted.
ContactPoint<2> contact_of_one(double gap, double p, double dt) {
  ImplicitBody<PlaneStrain> body;
  body.mix = concrete(0.0, 100.0);
  for (int d = 0; d < 2; ++d) body.grid.axes[d] = {.h = 0.02};
  const double ln_J = ln_J_under(p, body.mix.K), V = 1e-4;
  add_point<2>(body.points, {0.1 + gap, 0.1}, body.mix.density * V, V * std::exp(-ln_J), ln_J);
  activate(body.grid, body.points.x);
  const RigidWall<2> wall = [](const Vec<2>& x, double) -> std::optional<WallView<2>> {
    return WallView<2>{x[0] - 0.1, Vec<2>(1.0, 0.0), Vec<2>(0.0, 0.15)};
  };
  return find_contact(body.grid, body.points, wall, dt, dt, 0.005, 100.0, body.mix.K).at(0);
}

// A point that is 20 microns too near is pushed away in a millisecond, however short the step: over dt alone
// a step of 1e-6 s would throw it off at 20 m/s. A longer step closes the overlap by its end.
TEST(RigidWalls, CloseAnOverlapInTheirOwnTime) {
  EXPECT_NEAR(contact_of_one(0.005 - 20e-6, 0.0, 1e-6).target, 0.02, 1e-9);
  EXPECT_NEAR(contact_of_one(0.005 - 20e-6, 0.0, 2e-3).target, 0.01, 1e-9);
  EXPECT_NEAR(contact_of_one(0.006, 0.0, 1e-6).target, -1e3, 1e-6);  // free to come nearer
}

// What a layer of points under a pressure p gives way in a step, p A dt / stiffness with A = m/(rho 2 gap),
// keeps it on its side of the wall: at most the gap. A short step needs no more than the usual stiffness.
TEST(RigidWalls, HoldAPressureInALongStep) {
  const double p = 7e3, A = 0.01, gap = 0.005;
  for (double dt : {0.003, 0.03, 0.1}) {
    const auto contact = contact_of_one(gap, p, dt);
    EXPECT_LE(p * A * dt / contact.stiffness, 1.01 * gap) << dt;
    EXPECT_GE(contact.stiffness, 99.9 * 2400.0 * 1e-4 / dt) << dt;
  }
  EXPECT_NEAR(contact_of_one(gap, p, 0.003).stiffness / (100.0 * 0.24 / 0.003), 1.0, 1e-12);
}

// Two terms at a node are one drag: towards the mean of the walls' velocities, by the drag of each.
TEST(WallTerms, DragOfTermsAtOneNodeAddsUp) {
  NodeTerm<2> moves, stands, yields;
  moves.node = stands.node = 1;
  moves.viscous = 2.0, moves.velocity = {3.0, 0.0};
  stands.viscous = 4.0;
  EXPECT_TRUE(viscous_drag<2>({yields}, 2).empty());
  const auto drag = viscous_drag<2>({moves, stands, yields}, 2);
  ASSERT_EQ(drag.size(), 2U);
  EXPECT_EQ(drag[0].k, 0.0);
  EXPECT_EQ(drag[1].k, 6.0);
  EXPECT_EQ(drag[1].pull, Vec<2>(6.0, 0.0));
}

// At a given velocity the dual force of a term comes to the yield force along the slip, the split slip velocity to the
// slip; below the yield force there is none, and the force is what would be needed.
TEST(WallTerms, TheUpdateFindsTheYieldForce) {
  NodeTerm<2> term;
  term.normal_axis = 1, term.limit = 2.0, term.stiffness = 0.5, term.velocity = {1.0, 0.0};
  std::vector<NodeTerm<2>> terms{term};
  const std::vector<Vec<2>> v{Vec<2>(4.0, 7.0)};
  bool settled = false;
  for (int i = 0; i < 50; ++i) settled = update_admm<2>({}, v, 1.0, 1e-6, terms);
  EXPECT_TRUE(settled);
  EXPECT_NEAR(terms[0].force[0], 2.0, 1e-9);
  EXPECT_EQ(terms[0].force[1], 0.0);
  EXPECT_NEAR(terms[0].slip[0], 3.0, 1e-9);
  terms = {term};
  EXPECT_FALSE(update_admm<2>({}, v, 1.0, 1e-6, terms));
  EXPECT_EQ(terms[0].force[0], 1.5);
  EXPECT_EQ(terms[0].slip, Vec<2>(0.0, 0.0));
}

}  // namespace
}  // namespace tremie
