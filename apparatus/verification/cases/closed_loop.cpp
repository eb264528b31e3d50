// Case 9: material parameters, virtual vane, torque, fit, material parameters.

#include <fmt/format.h>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/verification/suite.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie::verification {
namespace {

struct Loop {
  Run yield_stress, plastic_viscosity;
};

Loop flow_curve_and_back(const Bingham& bingham, double cell_mm) {
  const double start = cpu_seconds();
  icar_vane::Scene scene;
  scene.mix.tau_0 = bingham.tau_0;
  scene.mix.mu = bingham.mu;
  scene.speeds = {0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05};
  scene.model.space = SpaceKind::couette;
  scene.model.cell = {1e-3 * cell_mm, 1e-3 * cell_mm};
  const auto outcome = icar_vane::run(scene);
  std::vector<FlowPoint> points;
  for (const auto& p : outcome.results.flow_curve) points.push_back({angular_speed(p.speed), p.torque});
  const Bingham fitted = bingham_from_flow_curve(points);
  const double cpu = cpu_seconds() - start;
  const std::string label = fmt::format("{:g} mm", cell_mm);
  return {{label, cell_mm, std::abs(fitted.tau_0 / bingham.tau_0 - 1.0), cpu},
          {label, cell_mm, std::abs(fitted.mu / bingham.mu - 1.0), cpu}};
}

}  // namespace

Case closed_loop_case(Depth depth) {
  Problem one{.name = "closed_loop",
              .title = "Flow curve of Mix A, Couette section",
              .equation = "(τ0, μ) → torque at seven speeds → (τ0, μ)",
              .reference = "the parameters that went in, 54 Pa and 35.8 Pa·s",
              .norm = "relative error of the parameter",
              .series = {{"yield stress", {}}, {"plastic viscosity", {}}}};
  for (double cell : {8.0, 4.0, 2.0, 1.0}) {
    if (cell == 1.0 && depth == Depth::quick) break;
    const Loop loop = flow_curve_and_back({54.0, 35.8}, cell);
    one.series[0].runs.push_back(loop.yield_stress);
    one.series[1].runs.push_back(loop.plastic_viscosity);
  }
  bound_errors(one, ": error at 2 mm", 0.02, 2);
  return {9, "Closed loop", {one}};
}

}  // namespace tremie::verification
