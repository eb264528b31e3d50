// What is thinner than a cell, and a surface that sinks in a long step.

#include <gtest/gtest.h>

#include <algorithm>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/step_size.hpp"

namespace tremie {
namespace {

constexpr double rho_g = 2400.0 * 9.81, tau_0 = 50.0, mu = 30.0;

template <class Geometry>
ImplicitBody<Geometry> film_on_a_wall(double thickness) {
  constexpr int up = Geometry::up;
  ImplicitBody<Geometry> body;
  body.mix = bodies::concrete(tau_0, mu);
  body.gravity[up] = -9.81;
  for (int d = 0; d <= up; ++d) body.grid.axes[d] = {.h = 0.01, .periodic = true, .n_cells = 4};
  body.grid.axes[0] = {.h = 0.01, .low = FaceKind::no_slip};
  Vec<Geometry::dim> high = Vec<Geometry::dim>::Constant(0.04);
  high[0] = thickness;
  bodies::fill_box(body, Vec<Geometry::dim>(Vec<Geometry::dim>::Zero()), high, up == 1 ? 20 : 10);
  return body;
}

/// Steady speed of the film's surface [m/s].
template <class Geometry = PlaneStrain>
double surface_speed(double thickness, bool fitted) {
  auto body = film_on_a_wall<Geometry>(thickness);
  StepSettings settings;
  settings.fixed_dt = 0.01;
  settings.cut_cell_rule = fitted;
  settings.admm.direct_below = 0;  // in 3D by iteration
  for (int i = 0; i < 6; ++i) EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  double speed = 0.0;
  for (const auto& v : body.points.v) speed = std::max(speed, -v[Geometry::up]);
  return speed;
}

// A Bingham film of less than tau_0 / rho g = 2.1 mm holds; a thicker one's plug slides at rho g s^2 / 2 mu,
// s what shears. One quadratic over a film has no corner at the plug: 10 %. With the places of a full cell
// the film that should hold slides at 8 mm/s.
TEST(ThinFilm, HoldsAndSlidesInPartOfACell) {
  for (double thickness : {0.0015, 0.004, 0.006}) {
    const double s = std::max(0.0, thickness - tau_0 / rho_g), exact = rho_g * s * s / (2.0 * mu);
    const double speed = surface_speed(thickness, true);
    std::printf("%g mm: %.3g mm/s, exact %.3g\n", 1e3 * thickness, 1e3 * speed, 1e3 * exact);
    EXPECT_NEAR(speed, exact, 0.1 * exact + 1e-5);
  }
  EXPECT_GT(surface_speed(0.0015, false), 1e-3);
}

// In 3D the places stay where they are, and a part of a thin film counts away from its wall: one that should hold does, thicker
// ones drain within a third of their speed, and none is slowed that drained before.
TEST(ThinFilm, HoldsAndSlidesInSpace) {
  EXPECT_LE(surface_speed<ThreeD>(0.0015, true), 1e-5);
  EXPECT_GT(surface_speed<ThreeD>(0.0015, false), 1e-3);
  for (double thickness : {0.004, 0.006, 0.008}) {
    const double s = thickness - tau_0 / rho_g, exact = rho_g * s * s / (2.0 * mu);
    const double speed = surface_speed<ThreeD>(thickness, true);
    std::printf("3D, %g mm: %.3g mm/s, exact %.3g\n", 1e3 * thickness, 1e3 * speed, 1e3 * exact);
    EXPECT_NEAR(speed, exact, 0.33 * exact);
    EXPECT_NEAR(speed, surface_speed<ThreeD>(thickness, false), 1e-6 * exact);
  }
}

/// A tilted pool of a viscous fluid in a box 0.4 m long (round its axis, of that radius; in space 40 mm wide), in `steps` of a
/// second: by how much the first quarter is deeper than the last one or the other way round, over the mean depth, at most over
/// the last quarter of the steps.
template <class Geometry>
double tilt_after_long_steps(bool moving_surface, int steps) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  constexpr double length = 0.4, width = D == 3 ? 0.04 : 1.0, mean_depth = 0.075;
  ImplicitBody<Geometry> body;
  body.mix = bodies::concrete(0.0, mu);
  body.gravity[up] = -9.81;
  Vec<D> top = Vec<D>::Constant(width);
  Index<D> points;
  points.fill(4);
  body.grid.axes[1] = {.h = 0.02, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 2};
  constexpr FaceKind first = std::is_same_v<Geometry, Axisymmetric> ? FaceKind::free_slip : FaceKind::no_slip;
  body.grid.axes[0] = {.h = 0.02, .low = first, .high = FaceKind::no_slip, .n_cells = 20};
  body.grid.axes[up] = {.h = 0.02, .low = FaceKind::no_slip};
  top[0] = length, top[up] = 0.1, points[0] = 80, points[up] = 20;
  const auto depth = [](double x) { return 0.09 - 0.075 * x; };
  seed_box<Geometry>(
      Vec<D>::Zero(), top, points, body.mix.density, body.mix.K,
      [&](const Vec<D>& x) { return x[up] < depth(x[0]); },
      [&](const Vec<D>& x) { return rho_g * (depth(x[0]) - x[up]); }, body.points);
  StepSettings settings;
  settings.fixed_dt = 1.0;
  settings.particle_shifting.on = true;
  settings.detached = 0.005;
  settings.alternating_viscosity = 100.0;
  settings.moving_surface = moving_surface;
  if (D == 3) settings.admm.direct_below = 0;
  double largest = 0.0;
  for (int i = 0; i < steps; ++i) {
    implicit_step(body, ExactBingham{}, settings);
    const auto quarter = [](double x) { return Geometry::measure(Vec<D>::Constant(x)) * 0.1 * width; };
    double difference = 0.0;
    for (std::size_t p = 0; p < body.points.size(); ++p) {
      const double x = body.points.x[p][0];
      if (x < 0.1) difference += body.points.volume(p) / quarter(0.05);
      if (x > 0.3) difference -= body.points.volume(p) / quarter(0.35);
    }
    if (4 * i >= 3 * steps) largest = std::max(largest, std::abs(difference) / mean_depth);
  }
  return largest;
}

// The pool levels in a fraction of a second. With its motion in the step it is level to half a row of points,
// 5 mm of 75; steps of a second that leave it out keep the surface going to and fro.
TEST(MovingSurface, LevelsInLongSteps) {
  const double with = tilt_after_long_steps<PlaneStrain>(true, 40),
               without = tilt_after_long_steps<PlaneStrain>(false, 40);
  std::printf("left over right %.2f %%, without its motion %.2f %%\n", 100 * with, 100 * without);
  EXPECT_LE(with, 0.035);
  EXPECT_GE(without, 0.1);
}

// Round an axis the head acts on the whole ring.
TEST(MovingSurface, LevelsInLongStepsRoundAnAxis) {
  const double with = tilt_after_long_steps<Axisymmetric>(true, 40),
               without = tilt_after_long_steps<Axisymmetric>(false, 40);
  std::printf("inside over outside %.2f %%, without its motion %.2f %%\n", 100 * with, 100 * without);
  EXPECT_LE(with, 0.035);
  EXPECT_GE(without, 0.07);
}

TEST(MovingSurface, LevelsInLongStepsInSpace) {
  const double with = tilt_after_long_steps<ThreeD>(true, 12),
               without = tilt_after_long_steps<ThreeD>(false, 12);
  std::printf("left over right %.2f %%, without its motion %.2f %%\n", 100 * with, 100 * without);
  EXPECT_LE(with, 0.035);
  EXPECT_GE(without, 0.1);
}

}  // namespace
}  // namespace tremie
