// A body of one's own, stepped: a film of Bingham concrete drains down a wall. At rest with itself its surface moves at
// rho g s^2/(2 mu), where s = d - tau_0/(rho g) is the depth that yields.

#include <algorithm>
#include <cstdio>

#include "libmpm/implicit/step.hpp"
#include "libmpm/particles/seeding.hpp"

int main() {
  using namespace tremie;
  constexpr double d = 0.04, height = 0.04, g = 9.81;
  ImplicitBody<PlaneStrain> body;
  body.mix = {.density = 2400.0, .tau_0 = 50.0, .mu = 30.0};
  body.gravity = {0.0, -g};
  body.grid.axes[0] = {.h = 0.005, .low = FaceKind::no_slip};       // x: the wall at 0
  body.grid.axes[1] = {.h = 0.01, .periodic = true, .n_cells = 4};  // y: goes on for ever
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {d, height}, {32, 16}, body.mix.density, body.mix.K, [](const auto&) { return true; },
      [](const auto&) { return 0.0; }, body.points);
  StepSettings settings;
  settings.fixed_dt = 0.2;
  bool converged = true;
  for (int i = 0; i < 10; ++i)
    converged = implicit_step(body, ExactBingham{}, settings).converged && converged;
  double surface = 0.0;
  for (const auto& v : body.points.v) surface = std::max(surface, -v[1]);
  const double s = d - body.mix.tau_0 / (body.mix.density * g);
  std::printf("surface_over_exact %.4f%s\n", surface / (body.mix.density * g * s * s / (2.0 * body.mix.mu)),
              converged ? "" : " unconverged");
}
