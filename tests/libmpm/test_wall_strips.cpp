// A wall law along a wall that cuts cells: a slab that slides down a slope.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"

namespace tremie {
namespace {

using namespace bodies;

constexpr double H = 0.1, h = 0.02, g = 9.81, rho = 2400.0, theta = 10.0 * std::numbers::pi / 180.0;
constexpr double driving = rho * g * H * 0.17364817766693033;  // rho g H sin theta: 409 Pa

/// A slab without ends, too stiff to shear, on a wall in the middle of a row of cells.
ImplicitBody<PlaneStrain> slab() {
  ImplicitBody<PlaneStrain> body;
  body.mix = concrete(5e4, 100.0);
  body.mix.density = rho;
  body.gravity = {g * std::sin(theta), -g * std::cos(theta)};
  body.grid.axes[0] = {.h = h, .periodic = true, .n_cells = 4};
  body.grid.axes[1] = {.h = h, .origin = -0.5 * h};
  fill_box(body, {0.0, 0.0}, {4.0 * h, H}, 4,
           [&](const auto& x) { return rho * g * std::cos(theta) * (H - x[1]); });
  constexpr int n = 6;
  for (int k = 0; k < n; ++k) {
    const Vec<2> x((k + 0.5) / n * 4.0 * h, 0.0), up(0.0, 1.0);
    body.boundary.push_back({.x = x, .normal = up});
    body.strips.push_back({.x = x, .normal = up, .area = 4.0 * h / n});
  }
  return body;
}

double speed_after(const Interface& law, double until) {
  omp_set_num_threads(1);
  auto body = slab();
  StepSettings settings;
  settings.wall_law = law;
  settings.boundary_stiffness = 1e6;
  settings.fixed_dt = 0.01;
  int unconverged = 0;
  while (body.time < until - 1e-9) unconverged += !implicit_step(body, ExactBingham{}, settings).converged;
  EXPECT_EQ(unconverged, 0);
  return momentum(body.points)[0] / total_mass(body.points);
}

// u = (driving - tau_i)/k_i (1 - exp(-k_i t/(rho H))) within 2 %: backward Euler in steps of 0.01 s has 1 % of it.
TEST(WallStrips, ASlabSlidesAsItsLawSays) {
  const Interface law{100.0, 1000.0};
  for (double t : {0.1, 0.5, 2.0}) {
    const double exact = (driving - law.tau_i) / law.k_i * -std::expm1(-law.k_i * t / (rho * H));
    EXPECT_NEAR(speed_after(law, t) / exact, 1.0, 0.02) << t;
  }
}

// A wall that takes more than drives the slab holds it: less than a thousandth of the speed that it would have.
TEST(WallStrips, ASlabThatIsDrivenTooLittleStays) {
  EXPECT_LT(std::abs(speed_after({1.2 * driving, 0.0}, 0.5)), 1e-3 * 0.5 * g * std::sin(theta));
}

// Without yield stress and drag it slips freely.
TEST(WallStrips, NothingHoldsASlabOnALayerOfNothing) {
  EXPECT_NEAR(speed_after({0.0, 0.0}, 0.5) / (0.5 * g * std::sin(theta)), 1.0, 1e-3);
}

}  // namespace
}  // namespace tremie
