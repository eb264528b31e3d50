// Tremie's flow in the cavity of cavity.toml, as CSV: cavity_profile YIELD_STRESS [CELLS]. Heights and velocities along the
// middle. The height is the first axis. Creeping flow is proportional to the lid's speed at a given Bingham number: lid and
// yield stress are taken a hundred times larger, far above the rates that count as rest, and density and step so small that
// the points stay where they are.

#include <omp.h>

#include <cstdio>
#include <cstdlib>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/implicit/step.hpp"
#include "libmpm/particles/seeding.hpp"

int main(int argc, char** argv) {
  using namespace tremie;
  constexpr double side = 0.1, lid_speed = 0.01, mu = 40.0, rho = 1e-4, scale = 100.0;
  const double tau_0 = argc > 1 ? std::atof(argv[1]) : 0.0;
  const int cells = argc > 2 ? std::atoi(argv[2]) : 64;
  omp_set_num_threads(1);
  ImplicitBody<PlaneStrain> body;
  body.mix.tau_0 = scale * tau_0, body.mix.mu = mu, body.mix.K = 1e12, body.mix.density = rho;
  body.gravity = {0.0, 0.0};
  for (auto& axis : body.grid.axes)
    axis = {.h = side / cells, .low = FaceKind::no_slip, .high = FaceKind::no_slip, .n_cells = cells};
  body.walls.v[0][1] = {
      0.0, scale * lid_speed};  // the second axis' walls hold the corners, so that nothing leaks there
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {side, side}, {2 * cells, 2 * cells}, rho, body.mix.K, [](const auto&) { return true; },
      [](const auto&) { return 0.0; }, body.points);
  StepSettings settings;
  settings.fixed_dt = 1e-6;
  settings.admm.tolerance = 1e-6;
  settings.admm.max_iterations = 20000;
  StepReport last;
  for (int i = 0; i < 3; ++i) last = implicit_step(body, ExactBingham{}, settings);

  std::printf("y_m,velocity_mm_per_s\n");
  for (int c = 0; c < body.grid.n_cells(); ++c) {
    if (body.grid.cell_index[c][1] != cells / 2) continue;
    for (const double height : {0.0, 0.25, 0.5, 0.75}) {
      const Vec<2> s(height, 0.0);  // the cells' edge is the middle
      const Stencil<2> st = stencil<2>(body.grid.axes, body.grid.cell_index[c], s);
      double v = 0.0;
      for (int i = 0; i < 9; ++i) v += st.N[i] * body.v[body.grid.cell_nodes[c][i]][1];
      std::printf("%.9g,%.9g\n", position_in_cell<2>(body.grid.axes, body.grid.cell_index[c], s)[0],
                  1e3 * v / scale);
    }
  }
  std::printf("%.9g,%.9g\n", side, 1e3 * lid_speed);
  return last.converged ? 0 : 1;
}
