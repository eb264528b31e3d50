// A container, or a cylinder, along which a layer slides, tau_i + k_i u, against Bingham's Couette flow whose wall turns:
//
//   Omega = Omega_Reiner-Riwlin(T) + u/R,   T = 2 pi R^2 h (tau_i + k_i u).

#include <gtest/gtest.h>
#include <omp.h>

#include <array>
#include <cmath>
#include <numbers>

#include "apparatus/icar_vane/ends.hpp"
#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/implicit/step.hpp"
#include "libmpm/particles/seeding.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double pi = std::numbers::pi, mu = 35.8, turns = 0.25, omega = 2.0 * pi * turns;

/// The ICAR's container; Newtonian, its wall holds 27.6 Pa, the cylinder 140 Pa.
Scene scene_in(SpaceKind space, double cell, double tau_0, const WallLaw& walls) {
  Scene scene;
  scene.model.space = space;
  scene.model.cell = {cell, cell};
  scene.mix.tau_0 = tau_0, scene.mix.mu = mu;
  scene.walls = walls;
  scene.speed = turns;
  scene.duration = 4.0;
  return scene;
}

/// The closed form's torque [N m], by halving; R: of the wall that slides.
double closed_form(double tau_0, const Interface& law, double R) {
  const Instrument in;
  const double area = 2.0 * pi * R * R * in.vane_height;
  double low = 0.0, high = reiner_riwlin({tau_0, mu}, omega, in).torque;
  for (int i = 0; i < 100; ++i) {
    const double T = 0.5 * (low + high), tau = T / area;
    const double turned = tau > law.tau_i ? (tau - law.tau_i) / (law.k_i * R) : 0.0;
    (reiner_riwlin_speed({tau_0, mu}, T, in) + turned < omega ? low : high) = T;
  }
  return 0.5 * (low + high);
}

/// Torque of a solid cylinder in a section of polar cells of size h: a quarter of the gap, steady.
double polar_torque(double tau_0, const Interface& law, double h) {
  omp_set_num_threads(1);
  const Vane vane;
  ImplicitBody<Polar> body;
  body.mix.tau_0 = tau_0, body.mix.mu = mu;
  const double gap = vane.container_radius - vane.radius, quarter = 0.5 * pi;
  const int n = static_cast<int>(std::lround(gap / h)), around = 8;
  body.grid.axes[0] = {.h = gap / n,
                       .origin = vane.radius,
                       .low = FaceKind::no_slip,
                       .high = FaceKind::wall_law,
                       .n_cells = n};
  body.grid.axes[1] = {.h = quarter / around, .periodic = true, .n_cells = around};
  body.walls.v[0][0] = {0.0, omega * vane.radius};
  seed_box<Polar>(
      {vane.radius, 0.0}, {vane.container_radius, quarter}, {2 * n, 2 * around}, body.mix.density, body.mix.K,
      [](const Vec<2>&) { return true; }, [](const Vec<2>&) { return 0.0; }, body.points);
  StepSettings settings;
  settings.keep_forces = true;
  settings.wall_law = law;
  settings.fixed_dt = 0.2;
  settings.admm.tolerance = 1e-5;
  while (body.time < 8.0) implicit_step(body, ExactBingham{}, settings);
  double blades = 0.0, wall = 0.0;
  for (int i = 0; i < body.grid.n_nodes(); ++i) {
    const int at = body.grid.node_index[i][0];
    if (body.grid.axes[0].on_low_wall(at)) blades += vane.radius * body.wall_force[i][1];
    if (body.grid.axes[0].on_high_wall(at)) wall -= vane.container_radius * body.wall_force[i][1];
  }
  EXPECT_NEAR(wall / blades, 1.0, 2e-3);
  return 4.0 * vane.height * blades;
}

/// Prints and bounds the errors on three grids, each of half the cells, by 1 %; the order between the last two is returned.
template <class Torque>
double order_of(const char* what, double exact, double cell, Torque torque) {
  std::array<double, 3> error;
  for (double& e : error) {
    e = std::abs(torque(cell) / exact - 1.0);
    std::printf("%s, cells of %.4g mm: %.4f %%\n", what, 1e3 * cell, 100.0 * e);
    EXPECT_LE(e, 0.01);
    cell *= 0.5;
  }
  return std::log2(error[1] / error[2]);
}

constexpr double container = 0.143, cylinder = 0.0635;
const Interface slippery{10.0, 300.0};  // slides at 42 mm/s of 225 in a Newtonian fluid

// Quadratic splines: the torque of a Newtonian fluid has order 2 to 4 here; 2 is asked for, 1.5 where the container slides. With a
// plug the orders are printed.
TEST(VaneWall, ALineOfCirclesSlidesAsTheClosedForm) {
  const auto couette = [&](double tau_0, const Interface& law, bool inner) {
    return [=](double cell) {
      Scene s = scene_in(SpaceKind::couette, cell, tau_0, law);
      s.cylinder_slides = inner;
      const Outcome o = run(s);
      EXPECT_TRUE(o.checks.reasons.empty()) << o.checks.reasons.front();
      EXPECT_NEAR(o.results.torque_wall_end / o.results.torque_end, 1.0, 2e-3);
      EXPECT_NEAR(o.results.torque_power_end / o.results.torque_end, 1.0, 2e-3);
      return o.results.torque_end;
    };
  };
  EXPECT_GE(
      order_of("container, 0 Pa", closed_form(0.0, slippery, container), 0.02, couette(0.0, slippery, false)),
      1.5);
  const Interface layer{60.0, 300.0};
  EXPECT_GE(order_of("cylinder, 0 Pa", closed_form(0.0, layer, cylinder), 0.02, couette(0.0, layer, true)),
            2.0);
  // With a plug that turns along the container, and one that stands around the cylinder's layer.
  const Interface under{30.0, 300.0};
  order_of("container, 54 Pa", closed_form(54.0, under, container), 0.005, couette(54.0, under, false));
  order_of("cylinder, 54 Pa", closed_form(54.0, layer, cylinder), 0.005, couette(54.0, layer, true));
}

TEST(VaneWall, APolarSectionSlidesAsTheClosedForm) {
  EXPECT_GE(order_of("polar, 0 Pa", closed_form(0.0, slippery, container), 0.02,
                     [](double h) { return polar_torque(0.0, slippery, h); }),
            2.0);
  order_of("polar, 54 Pa", closed_form(54.0, {30.0, 300.0}, container), 0.01, [](double h) {
    return polar_torque(54.0, {30.0, 300.0}, h);
  });
}

/// A solid cylinder in the steady space, without ends.
double steady_torque(double tau_0, const Interface& law, double cell) {
  omp_set_num_threads(1);
  Scene s = scene_in(SpaceKind::cylindrical, cell, tau_0, law);
  s.model.cell[1] = 0.03;  // the flow is the same all around
  EndsGrid grid(s, false);
  grid.n_shaft = grid.n_blade;
  SteadyBody body = steady_body(s, grid);
  const SteadyTorques t = turn_steadily(s, grid, turns, body);
  EXPECT_TRUE(t.solve.converged);
  EXPECT_NEAR(t.wall / t.blades, 1.0, 2e-3);
  EXPECT_NEAR(t.power / t.blades, 1.0, 2e-3);
  return s.vane.height / (grid.n_height * grid.cell[2]) * t.blades;
}

TEST(VaneWall, ASteadySpaceSlidesAsTheClosedForm) {
  EXPECT_GE(order_of("steady, 0 Pa", closed_form(0.0, slippery, container), 0.04,
                     [](double h) { return steady_torque(0.0, slippery, h); }),
            2.0);
  order_of("steady, 54 Pa", closed_form(54.0, {30.0, 300.0}, container), 0.01, [](double h) {
    return steady_torque(54.0, {30.0, 300.0}, h);
  });
}

// A layer that holds more than the concrete asks of it, or that hardly flows, is a wall that holds, to 0.1 %, in all
// three spaces; one without viscosity takes tau_i and no more.
TEST(VaneWall, HasItsLimits) {
  for (const SpaceKind space : {SpaceKind::couette, SpaceKind::plane, SpaceKind::cylindrical}) {
    const double cell = space == SpaceKind::couette ? 0.005 : space == SpaceKind::plane ? 0.01 : 0.02;
    const auto torque = [&](const WallLaw& law) {
      const Outcome o = run(scene_in(space, cell, 54.0, law));
      EXPECT_TRUE(o.checks.reasons.empty()) << o.checks.reasons.front();
      return o.results.torque_end;
    };
    const double holds = torque(NoSlip{});
    EXPECT_NEAR(torque(Interface{5000.0, 1e-3}) / holds, 1.0, 1e-3);
    EXPECT_NEAR(torque(Interface{0.0, 1e6}) / holds, 1.0, 1e-3);
    if (space == SpaceKind::cylindrical) continue;  // its floor takes a part
    const double area = 2.0 * pi * container * container * Vane{}.height;
    EXPECT_NEAR(torque(Interface{10.0, 0.0}) / (10.0 * area), 1.0, 0.01);
  }
}

// Blades: torque on them, on the container and by power are one, and the container's is that of its law at the slip that is
// read.
TEST(VaneWall, BladesInAContainerThatSlides) {
  const Outcome o = run(scene_in(SpaceKind::plane, 0.01, 54.0, slippery));
  const Results& r = o.results;
  const double area = 2.0 * pi * container * container * Vane{}.height;
  std::printf("blades: %.4f N m, slip %.2f mm/s\n", r.torque_end, 1e3 * r.slip_end);
  EXPECT_NEAR(r.torque_wall_end / r.torque_end, 1.0, 5e-3);
  EXPECT_NEAR(r.torque_power_end / r.torque_end, 1.0, 5e-3);
  EXPECT_NEAR(area * (slippery.tau_i + slippery.k_i * r.slip_end) / r.torque_wall_end, 1.0, 5e-3);
  EXPECT_TRUE(o.checks.reasons.empty());
}

}  // namespace
}  // namespace tremie::icar_vane
