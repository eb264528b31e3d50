// Case 5: the Couette line of the vane apparatus against Reiner-Riwlin and against the radial reference by
// IDA.

#include <fmt/format.h>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/verification/references/vane_finite_elements.hpp"
#include "apparatus/verification/suite.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie::verification {
namespace {

icar_vane::Scene scene_of(const Bingham& bingham, double speed, double cell_mm) {
  icar_vane::Scene scene;
  scene.mix.tau_0 = bingham.tau_0;
  scene.mix.mu = bingham.mu;
  scene.speed = speed;
  scene.model.space = SpaceKind::couette;
  scene.model.cell = {1e-3 * cell_mm, 1e-3 * cell_mm};
  return scene;
}

Run torque_error(const Bingham& bingham, double speed, double cell_mm) {
  const double start = cpu_seconds();
  icar_vane::Scene scene = scene_of(bingham, speed, cell_mm);
  scene.duration = 10.0;
  const auto outcome = icar_vane::run(scene);
  const double exact = reiner_riwlin(bingham, angular_speed(speed)).torque;
  return {fmt::format("{:g} mm", cell_mm), cell_mm, std::abs(outcome.results.torque_end / exact - 1.0),
          cpu_seconds() - start,
          outcome.checks.unconverged_steps ? fmt::format("{} unconverged", outcome.checks.unconverged_steps)
                                           : ""};
}

Problem steady(Depth depth) {
  Problem one{.name = "couette",
              .title = "Steady torque",
              .equation = "(1/r²) d(r² τ)/dr = 0 between r = 63.5 and 143 mm, exact Bingham",
              .reference = "Reiner-Riwlin, the plug's radius solved for",
              .norm = "relative error of the torque"};
  struct Flow {
    const char* name;
    Bingham bingham;
    double speed;
  };
  for (const Flow& flow : {Flow{"Mix A, 0.25 rev/s (plug)", {54, 35.8}, 0.25},
                           {"Mix B, 0.25 rev/s", {61, 29}, 0.25},
                           {"Mix C, 0.25 rev/s", {130, 30.2}, 0.25},
                           {"Mix A, 0.5 rev/s (no plug)", {54, 35.8}, 0.5},
                           {"366 Pa, 0.25 rev/s", {366, 35.8}, 0.25}}) {
    Series series{flow.name, {}};
    for (double cell : {8.0, 4.0, 2.0, 1.0}) {
      if (cell == 1.0 && depth == Depth::quick) break;
      series.runs.push_back(torque_error(flow.bingham, flow.speed, cell));
    }
    one.series.push_back(std::move(series));
  }
  bound_errors(one, ": error at 2 mm", 5e-3, 2);
  return one;
}

/// Worst relative error of a run's torque from 0.5 to 20 s.
double decay_error(const std::vector<icar_vane::Sample>& s, const CouetteDecay& reference) {
  double worst = 0.0;
  for (std::size_t k = 0, i = 1; k < reference.time.size(); ++k) {
    while (i + 1 < s.size() && s[i].time < reference.time[k]) ++i;
    const double share = (reference.time[k] - s[i - 1].time) / (s[i].time - s[i - 1].time);
    const double torque = s[i - 1].torque + share * (s[i].torque - s[i - 1].torque);
    if (reference.time[k] >= 0.5) worst = std::max(worst, std::abs(torque / reference.torque[k] - 1.0));
  }
  return worst;
}

icar_vane::Scene decay_scene(double cell_mm) {
  icar_vane::Scene scene = scene_of({54.0, 35.8}, 0.25, cell_mm);
  scene.mix.thixotropy = Thixotropy{1.3, GatedKinetics{0.0358}};
  scene.rest = 240.0;
  scene.duration = 20.0;
  scene.with_reference = false;
  return scene;
}

Problem decay(Depth depth) {
  Problem one{.name = "couette_decay",
              .title = "Torque decay after 240 s of rest",
              .equation = "μγ̇ + (1+λ)τ0 = T/(2πr²h), dλ/dt = −αλγ̇, gated; Mix A, α = 0.0358, 0.25 rev/s",
              .reference =
                  "the radial equations by SUNDIALS IDA, 800 intervals, tolerance 1e-8; the vane reaches its "
                  "speed within 0.1 s, as the instrument's motor does, or at once",
              .norm = "largest relative error of the torque from 0.5 to 20 s",
              .series = {{"speed reached in 0.1 s", {}}, {"reference at full speed from the start", {}}}};
  std::vector<double> times;
  for (int i = 0; i <= 40; ++i) times.push_back(0.5 * i);
  CouetteOptions options;
  options.intervals = 800;
  options.relative_tolerance = 1e-8;
  const double lambda = flocculation_after_rest(0.0, {.A_thix = 1.3}, 54.0, 240.0);
  CouetteFlow flow{{54.0, 35.8}, {1.3, GatedKinetics{0.0358}, lambda}, angular_speed(0.25), {}};
  const CouetteDecay at_once = thixotropic_couette(flow, times, {}, options);
  flow.omega_of_time = [&](double time) { return flow.omega * icar_vane::start_up(time); };
  const CouetteDecay started = thixotropic_couette(flow, times, {}, options);
  for (double cell : {8.0, 4.0, 2.0, 1.0}) {
    if (cell == 1.0 && depth == Depth::quick) break;
    const double start = cpu_seconds();
    const auto outcome = icar_vane::run(decay_scene(cell));
    const double cpu = cpu_seconds() - start;
    const std::string label = fmt::format("{:g} mm", cell);
    one.series[0].runs.push_back({label, cell, decay_error(outcome.series, started), cpu});
    one.series[1].runs.push_back({label, cell, decay_error(outcome.series, at_once), cpu});
  }
  bound_errors(one, ": error at the finest cells", 0.01);
  return one;
}

/// Steady torque on blades of 3 mm against the finite elements'.
Run blade_error(icar_vane::Scene scene, double cell_mm, double reference) {
  const double start = cpu_seconds();
  scene.model.cell = {1e-3 * cell_mm, 1e-3 * cell_mm};
  const auto outcome = icar_vane::run(scene);
  return {fmt::format("{:g} mm", cell_mm), cell_mm, std::abs(outcome.results.torque_end / reference - 1.0),
          cpu_seconds() - start};
}

Problem blades(Depth depth) {
  Problem one{.name = "blades",
              .title = "Steady torque on four blades, plane section, 0.25 rev/s",
              .equation = "div σ = 0 around blades of 3 mm in a container of 143 mm",
              .reference =
                  "finite elements in polar coordinates, quadratic velocities, the regularisation taken to "
                  "its limit (vane_finite_elements.hpp)",
              .norm = "relative error of the torque"};
  struct Fluid {
    const char* name;
    double tau_0;
    YieldLaw law;
  };
  for (const Fluid& fluid : {Fluid{"Newtonian", 0.0, ExactBingham{}},
                             {"Mix A, exact yield by ADMM", 54.0, ExactBingham{}},
                             {"Mix A, Papanastasiou m = 100 s by Newton", 54.0, Papanastasiou{100.0}}}) {
    icar_vane::Scene scene = scene_of({fluid.tau_0, 35.8}, 0.25, 10.0);
    scene.model.space = SpaceKind::plane;
    scene.model.points_per_cell = {3, 3};
    scene.model.law = fluid.law;
    scene.duration = 1.0;
    const double reference = finite_element_torque(blade_flow_of(scene, 16));
    Series series{fluid.name, {}};
    for (double cell : {10.0, 5.0, 2.5}) {
      if (cell == 2.5 && depth == Depth::quick) break;
      series.runs.push_back(blade_error(scene, cell, reference));
    }
    one.series.push_back(std::move(series));
  }
  bound_errors(one, ": error at 5 mm", 0.01, 1);
  return one;
}

}  // namespace

Case couette_case(Depth depth) { return {5, "Couette flow", {steady(depth), decay(depth), blades(depth)}}; }

}  // namespace tremie::verification
