// The slump of a Bingham concrete on a no-slip floor, axisymmetric, and nothing else: no scene, no files, one
// law and one space in the program; with readings, the line of the series that every step of a scene asks
// for. What the program `tremie` takes beyond it for the same steps is what a scene carries that it does not
// need.
//
//   bare_slump CELL_M DURATION_S [readings]     prints steps, points and the last spread

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "apparatus/parts/cone/series.hpp"

int main(int argc, char** argv) {
  using namespace tremie;
  if (argc < 3) return 2;
  const bool readings = argc > 3;
  cone::Scene scene;
  scene.mix.tau_0 = 54.0, scene.mix.mu = 35.8;
  scene.lift_speed.reset();
  scene.model.cell = {std::atof(argv[1]), 0.5 * std::atof(argv[1])};
  scene.duration = std::atof(argv[2]);

  ImplicitBody<Axisymmetric> body{cone::filled_cone<Axisymmetric>(scene)};
  StepSettings settings = cone::step_settings(scene);
  std::vector<cone::Sample> series;
  long steps = 0;
  for (; body.time < scene.duration * (1.0 - 1e-12); ++steps) {
    settings.dt_max = std::min(StepSettings{}.dt_max, scene.duration - body.time);
    const StepReport step = implicit_step(body, ExactBingham{}, settings, RigidWall<2>{});
    if (readings) series.push_back(cone::read(scene, body, step));
  }
  std::printf("%ld %zu %g\n", steps, body.points.size(), series.empty() ? 0.0 : series.back().spread);
}
