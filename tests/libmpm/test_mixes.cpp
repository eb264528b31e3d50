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

/// A channel from the plane of symmetry to a wall, of 16 cells; the inner half is of mixes[0], the outer of mixes[1].
ImplicitBody<PlaneStrain> channel_of(const Mix& inner, const Mix& outer, double h, double gravity) {
  ImplicitBody<PlaneStrain> body;
  body.mix = inner;
  body.mixes = {inner, outer};
  body.gravity[1] = -gravity;
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::no_slip, .n_cells = 16};
  body.grid.axes[1] = {.h = h, .periodic = true, .n_cells = 3};
  fill_box<PlaneStrain>(body, {0.0, 0.0}, {16 * h, 3 * h}, 2);
  for (const Vec<2>& x : body.points.x) body.points.mix.push_back(x[0] < 8 * h ? 0 : 1);
  return body;
}

/// Speed of a Bingham layer by its distance x from the middle, over that at the distance `to`, under the shear stress f x.
double layer_speed(const Mix& mix, double f, double x, double to) {
  const double from = std::max(x, mix.tau_0 / f);  // nearer to the middle it is a plug
  return (0.5 * f * (to * to - from * from) - mix.tau_0 * (to - from)) / mix.mu;
}

// Two concretes side by side sink in a channel: the shear stress is f x whatever they are, and each shears by its own yield stress
// and viscosity. Second-order splines on 16 cells with the boundary at a face: within 2 % of the largest speed, as one mix is in
// an annulus (test_inlet.cpp).
TEST(Mixes, TwoLayersSinkInAChannel) {
  omp_set_num_threads(1);
  constexpr double h = 0.04, f = 211.0;
  const Mix inner = concrete(20.0, 60.0, 350e6), outer = concrete(54.0, 20.0, 350e6);
  auto body = channel_of(inner, outer, h, f / inner.density);
  StepSettings settings;
  settings.fixed_dt = 1.0;
  settings.admm.tolerance = 1e-4;
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  const auto exact = [&](double x) {
    return x > 8 * h ? layer_speed(outer, f, x, 16 * h)
                     : layer_speed(inner, f, x, 8 * h) + layer_speed(outer, f, 8 * h, 16 * h);
  };
  double worst = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    worst = std::max(worst, std::abs(-body.points.v[p][1] - exact(body.points.x[p][0])));
  std::printf("two layers: largest error %.2f %% of the plug's speed\n", 100.0 * worst / exact(0.0));
  EXPECT_LE(worst, 0.02 * exact(0.0));
}

// At rest each gains structure at its own rate, in closed form.
TEST(Mixes, EachGainsItsOwnStructure) {
  omp_set_num_threads(1);
  Mix inner = concrete(50.0, 30.0), outer = concrete(80.0, 30.0);
  inner.thixotropy = {.A_thix = 1.0}, outer.thixotropy = {.A_thix = 0.2};
  auto body = channel_of(inner, outer, 0.04, 0.0);
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
