#include "apparatus/slump_flow/slump_flow.hpp"

#include <stdexcept>

#include "apparatus/slump_flow/engine.hpp"

namespace tremie::slump_flow {
namespace {

void refuse_what_has_no_engine(const Scene& scene) {
  engine::refuse_what_has_no_engine(scene.model, "slump flow");
}

template <class Space>
void count(const Scene& scene, Estimate& e) {
  Body<Space> body = filled_cone<Space>(scene);
  activate(body.grid, body.points);
  e.points = static_cast<std::int64_t>(body.points.size());
  e.cells_active = body.grid.n_cells();
  e.bytes_per_point = bytes_per_point<Space::dim>(body.points.thixotropic());
}

}  // namespace

Outcome run(const Scene& scene, const Observer& observer) {
  refuse_what_has_no_engine(scene);
  omp_set_num_threads(scene.threads);
  return engine::with_law(scene.model, [&](const auto& law) {
    return scene.model.space == SpaceKind::axisymmetric ? run_in<Axisymmetric>(scene, law, observer)
                                                        : run_in<ThreeD>(scene, law, observer);
  });
}

Estimate estimate(const Scene& scene) {
  refuse_what_has_no_engine(scene);
  Estimate e;
  if (scene.model.space == SpaceKind::axisymmetric)
    count<Axisymmetric>(scene, e);
  else
    count<ThreeD>(scene, e);
  const StepSettings settings = step_settings(scene);
  // The collapse runs at about sqrt(g H) for 0.4 s at the CFL limit, the rest of the flow at the largest
  // step.
  const double speed = std::sqrt(gravity * scene.cone.height);
  const double collapse = 0.4 * speed / (settings.cfl * std::min(scene.model.cell[0], scene.model.cell[1]));
  e.steps = scene.model.time_step ? std::llround(scene.duration / *scene.model.time_step)
                                  : std::llround(0.5 * collapse + scene.duration / settings.dt_max);
  return e;
}

std::string spread_class(double spread) {
  const long mm = 10 * std::lround(100.0 * spread);
  if (mm >= 550 && mm <= 650) return "SF1";
  if (mm >= 660 && mm <= 750) return "SF2";
  if (mm >= 760 && mm <= 850) return "SF3";
  return "";
}

}  // namespace tremie::slump_flow
