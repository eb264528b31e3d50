#include "apparatus/icar_vane/ends.hpp"

#include <fmt/format.h>

#include <numbers>

#include "apparatus/icar_vane/instrument.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double most_inertia =
    10.0;  // Reynolds number up to which the flow is taken for one without inertia
// Cells: a sheared layer of fewer makes the torque more than 2 % too high.
constexpr double thinnest_layer = 2.0;

/// The test's stages; of a constant speed the start is one of its own, so that a record has more than one line.
std::vector<Stage> lines_of(const Scene& scene) {
  std::vector<Stage> stages = stages_of(scene);
  if (scene.speeds.empty()) {
    const double start = std::min(start_up_time, scene.duration);
    stages = {{scene.speed, start}, {scene.speed, scene.duration - start}};
  }
  std::erase_if(stages, [](const Stage& stage) { return stage.duration <= 0.0; });
  return stages;
}

/// The cells' middles all around, as a standing observer sees them after the vane has turned by `turned`.
Frame frame_of(const Scene& scene, const SteadyBody& body, double time, double turned) {
  Frame frame;
  frame.time = time;
  const double sector = 2.0 * std::numbers::pi / scene.vane.blades;
  for (int c = 0; c < body.grid.n_cells(); ++c) {
    const Vec<3> x = position_in_cell<3>(body.grid.axes, body.grid.cell_index[c], Vec<3>::Constant(0.5));
    const Vec<3> v = velocity_in_middle(body, c);
    const double shear_rate = shear_rate_of_cell(body, c), pressure = steady_pressure(body, c);
    for (int b = 0; b < scene.vane.blades; ++b) {
      const double a = turned + (b - 0.5) * sector + x[1], cos = std::cos(a), sin = std::sin(a);
      frame.position.push_back({x[0] * cos, x[0] * sin, x[2]});
      frame.velocity.push_back({v[0] * cos - v[1] * sin, v[0] * sin + v[1] * cos, v[2]});
      frame.volume.push_back(body.quadrature.V_cell[c]);
      frame.pressure.push_back(pressure);
      frame.shear_rate.push_back(shear_rate);
    }
  }
  return frame;
}

double mean_shear_rate(const SteadyBody& body) {
  double sum = 0.0, volume = 0.0;
  for (int c = 0; c < body.grid.n_cells(); ++c) {
    sum += body.quadrature.V_cell[c] * shear_rate_of_cell(body, c);
    volume += body.quadrature.V_cell[c];
  }
  return sum / volume;
}

/// Means around, along the blades' height.
std::vector<ProfilePoint> profile_of(const EndsGrid& grid, const SteadyBody& body) {
  const auto n = static_cast<std::size_t>(grid.n_radial);
  std::vector<double> V(n, 0.0), v(n, 0.0), g(n, 0.0);
  for (int c = 0; c < body.grid.n_cells(); ++c) {
    const auto& at = body.grid.cell_index[c];
    if (at[2] < grid.n_bottom || at[2] >= grid.n_bottom + grid.n_height) continue;
    const auto ring = static_cast<std::size_t>(at[0]);
    V[ring] += body.quadrature.V_cell[c];
    v[ring] += body.quadrature.V_cell[c] * velocity_in_middle(body, c)[1];
    g[ring] += body.quadrature.V_cell[c] * shear_rate_of_cell(body, c);
  }
  std::vector<ProfilePoint> profile;
  for (std::size_t k = 0; k < n; ++k)
    if (V[k] > 0.0)
      profile.push_back(
          {grid.inner + (static_cast<double>(k) + 0.5) * grid.cell[0], v[k] / V[k], g[k] / V[k]});
  return profile;
}

/// Whether the torque shears the concrete at the vane at all: where a wall slides it may turn as one body.
bool shears(const Scene& scene, double torque) {
  const double R = scene.vane.radius;
  return !slides(scene) || torque > 2.0 * std::numbers::pi * R * R * scene.vane.height * scene.mix.tau_0;
}

/// What a steady flow without inertia on these cells cannot tell. `largest`: of its torques.
void judge(const Scene& scene, const EndsGrid& grid, double fastest, double slowest, double largest,
           Checks& checks) {
  const Mix& mix = scene.mix;
  const double R = scene.vane.radius, omega = angular_speed(std::abs(fastest));
  const double mu = mix.mu + viscosity(scene.model.law, omega, mix.tau_0);
  const double inertia = mix.density * omega * R * R / (mu + mix.tau_0 / omega);
  if (inertia > most_inertia)
    checks.reasons.push_back(fmt::format(
        "model.space = \"cylindrical\" leaves inertia out, and the Reynolds number is {:.3g}; it counts from "
        "about {:g} on: use a lower test.speed",
        inertia, most_inertia));
  const double slow = angular_speed(std::abs(slowest));
  const double layer = R * std::sqrt((mix.mu + viscosity(scene.model.law, slow, mix.tau_0)) * slow /
                                     std::max(1e-9, mix.tau_0));
  if (mix.tau_0 > 0.0 && layer < thinnest_layer * grid.cell[0] && shears(scene, largest))
    checks.reasons.push_back(fmt::format(
        "the concrete is sheared in a layer of about {:.2g} mm at the vane, which cells of {:.2g} mm do "
        "not resolve: use a smaller model.cell",
        1e3 * layer, 1e3 * grid.cell[0]));
}

}  // namespace

Outcome run_with_ends(const Scene& scene, const scene::Observer& observer) {
  const EndsGrid grid(scene, true);
  SteadyBody body = steady_body(scene, grid);
  PlaneSections plane = plane_sections(scene);
  Outcome outcome;
  double time = 0.0, turned = 0.0, last_speed = 0.0;
  SteadyTorques t;
  PlaneTorques p;
  const auto stages = lines_of(scene);
  double fastest = 0.0, slowest = 1e300, largest = 0.0;
  for (const auto& [speed, duration] : stages) {
    if (observer.interrupted && *observer.interrupted) {
      outcome.status = Status::interrupted;
      break;
    }
    if (speed != last_speed) {
      t = turn_steadily(scene, grid, speed, body);
      p = turn_steadily(scene, speed, plane);
      outcome.checks.unconverged_steps += t.solve.converged && p.converged ? 0 : 1;
      outcome.cost.steps += 1;
    }
    const double resolved = p.resolved / p.on_cells;
    last_speed = speed, time += duration, turned += angular_speed(speed) * duration;
    fastest = std::max(fastest, std::abs(speed)), slowest = std::min(slowest, std::abs(speed));
    largest = std::max(largest, std::abs(t.blades));
    outcome.series.push_back({.time = time,
                              .speed = speed,
                              .torque = resolved * t.blades,
                              .torque_wall = resolved * t.wall,
                              .torque_power = resolved * t.power,
                              .shear_rate_mean = mean_shear_rate(body),
                              .time_step = duration,
                              .iterations = t.solve.iterations,
                              .slip = t.slip});
    if (observer.on_progress)
      observer.on_progress({time, whole_time(scene), duration, progress_text(outcome.series.back())});
  }
  outcome.cost.simulated = time;
  outcome.cost.cells_active = outcome.cost.points = body.grid.n_cells();
  outcome.cost.bytes_per_point = estimate_with_ends(scene).bytes_per_point;
  outcome.final_frame = frame_of(scene, body, time, turned);
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  if (outcome.series.empty()) return outcome;
  if (outcome.checks.unconverged_steps > 0)
    outcome.checks.reasons.push_back(fmt::format("{} of {} steady flows did not converge to the tolerance",
                                                 outcome.checks.unconverged_steps, outcome.cost.steps));
  judge(scene, grid, fastest, slowest, largest, outcome.checks);
  outcome.checks.max_speed_end = angular_speed(std::abs(last_speed)) * scene.vane.radius;
  outcome.results.profile = profile_of(grid, body);
  outcome.results.torque_plane = p.resolved;
  outcome.results.end_factor = t.blades / p.on_cells;
  read_and_check(scene, outcome);
  return outcome;
}

scene::SizeEstimate estimate_with_ends(const Scene& scene) {
  const EndsGrid grid(scene, true);
  // The band couples two layers of nodes across the longest axis; its factor is most of the memory and of the time.
  const double layers[3] = {grid.n_radial + 4.0, grid.n_around + 2.0,
                            grid.n_bottom + grid.n_height + grid.n_cover + 4.0};
  const double n = 3.0 * layers[0] * layers[1] * layers[2];
  const double band = 2.1 * n / std::max({layers[0], 0.5 * layers[1], layers[2]});
  scene::SizeEstimate e;
  e.points = e.cells_active = grid.n_cells();
  e.bytes_per_point = static_cast<std::int64_t>(8.0 * n * band / grid.n_cells() +
                                                sizeof(Quadrature<Cylindrical>::StrainRows) * 8.0);
  e.steps = e.steps_expected = static_cast<std::int64_t>(stages_of(scene).size());
  for (const auto& [speed, duration] : stages_of(scene)) e.time_expected += duration;
  e.point_step =
      (1e-10 * n * band * band + 100.0 * (1.5e-9 * n * band + 1e-5 * grid.n_cells())) / grid.n_cells();
  return e;
}

}  // namespace tremie::icar_vane
