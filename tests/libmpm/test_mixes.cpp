// Concretes of several mixes in one body.

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apparatus/verification/references/bodies.hpp"

namespace tremie {
namespace {

using namespace bodies;

/// A channel of so many cells from the plane of symmetry to a wall 64 cm away; the inner half is of mixes[0], the outer of mixes[1].
ImplicitBody<PlaneStrain> channel_of(const Mix& inner, const Mix& outer, int cells, double gravity) {
  const double h = 0.64 / cells;
  ImplicitBody<PlaneStrain> body;
  body.mix = inner;
  body.mixes = {inner, outer};
  body.gravity[1] = -gravity;
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::no_slip, .n_cells = cells};
  body.grid.axes[1] = {.h = h, .periodic = true, .n_cells = 3};
  fill_box<PlaneStrain>(body, {0.0, 0.0}, {0.64, 3 * h}, 2);
  for (const Vec<2>& x : body.points.x) body.points.mix.push_back(x[0] < 0.32 ? 0 : 1);
  return body;
}

/// Speed of a Bingham layer by its distance x from the middle, over that at the distance `to`, under the shear stress f x.
double layer_speed(const Mix& mix, double f, double x, double to) {
  const double from = std::max(x, mix.tau_0 / f);  // nearer to the middle it is a plug
  return (0.5 * f * (to * to - from * from) - mix.tau_0 * (to - from)) / mix.mu;
}

/// Largest error of the speed over the plug's where two concretes sink side by side.
double error_of_two_layers(int cells) {
  constexpr double f = 211.0;
  const Mix inner = concrete(20.0, 60.0, 350e6), outer = concrete(54.0, 20.0, 350e6);
  auto body = channel_of(inner, outer, cells, f / inner.density);
  StepSettings settings;
  settings.fixed_dt = 1.0;
  settings.admm.tolerance = 1e-4;
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  const auto exact = [&](double x) {
    return x > 0.32 ? layer_speed(outer, f, x, 0.64)
                    : layer_speed(inner, f, x, 0.32) + layer_speed(outer, f, 0.32, 0.64);
  };
  double worst = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    worst = std::max(worst, std::abs(-body.points.v[p][1] - exact(body.points.x[p][0])));
  std::printf("two layers on %d cells: largest error %.2f %% of the plug's speed\n", cells,
              100.0 * worst / exact(0.0));
  return worst / exact(0.0);
}

// The shear stress is f x whatever the concretes are, and each shears by its own yield stress and viscosity. Their boundary is a face
// of the cells. 200 s are some fifteen times the slowest decay. Splines smooth the jump of the shear rate: 1 % is asked of 16 cells,
// and less of 32.
TEST(Mixes, TwoLayersSinkInAChannel) {
  omp_set_num_threads(1);
  const double coarse = error_of_two_layers(16), fine = error_of_two_layers(32);
  EXPECT_LE(coarse, 0.01);
  EXPECT_LE(fine, 0.7 * coarse);
}

// At rest each gains structure at its own rate, in closed form.
TEST(Mixes, EachGainsItsOwnStructure) {
  omp_set_num_threads(1);
  Mix inner = concrete(50.0, 30.0), outer = concrete(80.0, 30.0);
  inner.thixotropy = {.A_thix = 1.0}, outer.thixotropy = {.A_thix = 0.2};
  auto body = channel_of(inner, outer, 16, 0.0);
  body.points.lambda.assign(body.points.size(), 0.0), body.points.gamma_dot = body.points.lambda;
  StepSettings settings;
  settings.fixed_dt = 1.0;
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const Mix& mix = body.points.mix[p] == 0 ? inner : outer;
    EXPECT_NEAR(body.points.lambda[p], flocculation_after_rest(0.0, *mix.thixotropy, mix.tau_0, 30.0), 1e-9);
  }
}

}  // namespace
}  // namespace tremie
