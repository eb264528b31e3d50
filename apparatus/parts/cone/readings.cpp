#include "apparatus/parts/cone/readings.hpp"

#include <algorithm>

namespace tremie::cone {

std::vector<scene::Chart> charts_of(const Scene& scene, std::vector<scene::Reference> measured_spread) {
  std::vector<scene::Chart> charts{
      {"spread.svg", "Spread", time_label, "spread (mm)", {"spread_mm"}, std::move(measured_spread)}};
  charts.push_back(
      {"shear_rate.svg", "Mean shear rate", time_label, "mean shear rate (1/s)", {"shear_rate_mean_per_s"}});
  if (scene.mix.thixotropy) {
    charts.push_back(
        {"flocculation.svg", "Flocculation", time_label, "mean flocculation state λ", {"flocculation_mean"}});
  }
  return charts;
}

scene::Stage stage_of(const Scene& scene) {
  scene::Stage stage;
  stage.mirrored = scene.model.space != SpaceKind::full;
  stage.slice = scene.model.space == SpaceKind::axisymmetric ? 0.0 : scene.model.cell[0];
  if (scene.lift_speed) {
    stage.lifted = {{{scene.cone.bottom_radius, 0.0}, {scene.cone.top_radius, scene.cone.height}}};
    stage.lift_speed = *scene.lift_speed;
    if (!stage.mirrored)
      stage.lifted.push_back({{-scene.cone.bottom_radius, 0.0}, {-scene.cone.top_radius, scene.cone.height}});
  }
  const double across = scene.model.cell[0] / scene.model.points_per_cell[0];
  stage.point_size = std::max(across, scene.model.cell[1] / scene.model.points_per_cell[1]);
  stage.plan = "spread_mm";
  stage.ring_diameter = 0.5;
  return stage;
}

std::vector<std::string> uses(const Scene& scene) {
  const Model& model = scene.model;
  std::vector<std::string> lines{scene::flocculation_use(scene.mix)};
  lines.push_back(std::string("floor friction: ") + use(scene.floor.contact));
  lines.push_back(scene.lift_speed ? "cone: a moving rigid wall"
                                   : "cone: left out (test.lift_speed = \"instant\")");
  lines.push_back(model.space == SpaceKind::axisymmetric
                      ? "third dimension: left out (model.space = \"axisymmetric\")"
                      : "third dimension: computed");
  scene::add_model_uses(model, lines);
  return lines;
}

}  // namespace tremie::cone
