// Polar coordinates: bodies that turn, and blocks of cells.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"

namespace tremie {
namespace {

using namespace bodies;

constexpr double r_in = 0.05, r_out = 0.15;

/// A quarter of a ring of concrete between walls without friction, that turns as a whole.
ImplicitBody<Polar> turning_ring(double omega, double grid_rate) {
  omp_set_num_threads(1);
  ImplicitBody<Polar> body;
  body.mix = concrete(54.0, 35.8);
  body.grid.axes[0] = {
      .h = 0.02, .origin = r_in, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 5};
  body.grid.axes[1] = {.h = 0.5 * std::numbers::pi / 8, .periodic = true, .n_cells = 8};
  body.motion.grid_rate = grid_rate;
  fill_box<Polar>(body, {r_in, 0.0}, {r_out, 0.5 * std::numbers::pi}, 2);
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    body.points.v[p] = {0.0, omega * body.points.x[p][0]};
    body.points.C[p](1, 0) = omega;
  }
  return body;
}

/// About the axis, with the spin of the points' affine velocities: r v_theta summed over the nodes of the
/// last step, which the transfer to the points keeps.
double angular_momentum_of(const ImplicitBody<Polar>& body) {
  double sum = 0.0;
  for (int i = 0; i < body.grid.n_nodes(); ++i)
    sum += body.grid.node_position(i)[0] * body.nodes.mass[i] * body.v[i][1];
  return sum;
}

// Nothing brakes it, in a grid that stands, turns with it or against it. Over 1000 steps its angular momentum
// stays but for the spin of the points' affine velocities, whose arm changes as points next to the walls
// breathe by 2e-6 of their radius: 1e-8. Radii stay but for what the centrifugal pressure compresses, rho
// (omega r)^2/K = 2e-4; the step's length plays no role, points move along arcs.
TEST(Polar, ATurningRingKeepsAngularMomentumAndRadii) {
  for (double grid_rate : {0.0, 2.0, -1.0}) {
    auto body = turning_ring(2.0, grid_rate);
    const auto start = body.points;
    StepSettings settings;
    settings.fixed_dt = 0.01;
    implicit_step(body, ExactBingham{}, settings);
    const double first = angular_momentum_of(body);
    for (int i = 1; i < 1000; ++i) EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
    double worst = 0.0;
    for (std::size_t p = 0; p < start.size(); ++p)
      worst = std::max(worst, std::abs(body.points.x[p][0] / start.x[p][0] - 1.0));
    const double drift = angular_momentum_of(body) / first - 1.0;
    std::printf("grid at %g rad/s: angular momentum drifts by %.1e, radii by %.1e\n", grid_rate, drift,
                worst);
    EXPECT_LE(std::abs(drift), 1e-8);
    EXPECT_LE(worst, 2e-4);
  }
}

// Without forces a point goes straight on: after a second in steps of 1 ms it is where Cartesian coordinates
// have it, within the first order of the steps.
TEST(Polar, APointWithoutForcesGoesStraight) {
  for (double grid_rate : {0.0, 3.0}) {
    Points<2> points;
    add_point<2>(points, {0.1, 0.0}, 1.0, 1.0, 0.0);
    points.v[0] = {0.02, 0.1};
    const Motion<Polar> motion{grid_rate};
    for (int i = 0; i < 1000; ++i) motion.move(points, 0, points.v[0], 1e-3);
    const double r = points.x[0][0], theta = points.x[0][1] + grid_rate;
    EXPECT_NEAR(r * std::cos(theta), 0.12, 2e-4);
    EXPECT_NEAR(r * std::sin(theta), 0.1, 2e-4);
    EXPECT_NEAR(r * points.v[0][1], 0.1 * 0.1, 1e-12);
  }
}

// A block holds every node in and on it; no concrete enters its cells, and the cells beside it count as
// inside the body.
TEST(Polar, ABlockHoldsItsNodesAndKeepsConcreteOut) {
  auto body = turning_ring(0.0, 1.0);  // the grid turns with the block
  body.grid.axes[0].repeated_knots = {3};
  body.grid.axes[1].repeated_knots = {3, 5};
  body.grid.blocks = {{{0, 3}, {3, 5}, [](const Vec<2>& x) { return Vec<2>(0.0, x[0]); }}};
  Points<2> outside;
  for (const Vec<2>& x : body.points.x)
    if (!block_of_cell<2>(body.grid, detail::cell_of<2>(body.grid.axes, x)))
      add_point<2>(outside, x, 1e-3, 1e-6, 0.0);
  body.points = outside;
  StepSettings settings;
  settings.fixed_dt = 0.05;
  settings.keep_forces = true;
  for (int i = 0; i < 5; ++i) implicit_step(body, ExactBingham{}, settings);
  int held = 0;
  for (int i = 0; i < body.grid.n_nodes(); ++i) {
    if (!block_of_node<2>(body.grid, body.grid.node_index[i])) continue;
    ++held;
    EXPECT_EQ(body.v[i], Vec<2>(0.0, body.grid.node_position(i)[0]));
  }
  EXPECT_EQ(held, 5 * 2 + 2);  // both sides and the tip: nodes within belong to no cell with concrete
  EXPECT_EQ(body.points.size(), outside.size());
  for (const Vec<2>& x : body.points.x)
    EXPECT_EQ(block_of_cell<2>(body.grid, detail::cell_of<2>(body.grid.axes, x)), nullptr);
  EXPECT_TRUE(is_inside<2>(body.grid, {3, 4}));
  EXPECT_TRUE(is_inside<2>(body.grid, {1, 2}));
}

}  // namespace
}  // namespace tremie
