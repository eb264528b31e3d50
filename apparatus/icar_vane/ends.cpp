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
constexpr double sheet = 0.5;  // of a cell around: a thinner blade is a sheet

int cells(double length, double size, int least) {
  return std::max(least, static_cast<int>(std::lround(length / size)));
}

/// Cells along the blades, of at most about the size: as many as put faces nearest to the floor and the surface.
int cells_along(const Vane& vane, double size) {
  const int least = cells(vane.height, size, 2);
  int best = least;
  double nearest = 1e9;
  for (int n = least; n <= least + least / 4; ++n) {
    const double h = vane.height / n;
    const auto off = [&](double gap) { return std::abs(std::max(1.0, std::round(gap / h)) * h / gap - 1.0); };
    const double miss = off(vane.bottom_gap) + off(vane.cover) + 0.002 * (n - least);
    if (miss < nearest - 1e-9) nearest = miss, best = n;
  }
  return best;
}

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

/// Torque of the plane section times the height, on the same cells [N m].
double plane_torque(const Scene& scene, double speed, Checks& checks) {
  const EndsGrid grid(scene, false);
  SteadyBody body = steady_body(scene, grid);
  const SteadyTorques t = turn_steadily(scene, grid, speed, body);
  if (!t.solve.converged) checks.reasons.push_back("the plane section did not converge to the tolerance");
  return t.blades * scene.vane.height / (grid.n_height * grid.cell[2]);
}

/// What a steady flow without inertia on these cells cannot tell.
void judge(const Scene& scene, const EndsGrid& grid, double fastest, double slowest, Checks& checks) {
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
  if (mix.tau_0 > 0.0 && layer < thinnest_layer * grid.cell[0])
    checks.reasons.push_back(fmt::format(
        "the concrete is sheared in a layer of about {:.2g} mm at the vane, which cells of {:.2g} mm do "
        "not resolve: use a smaller model.cell",
        1e3 * layer, 1e3 * grid.cell[0]));
}

}  // namespace

EndsGrid::EndsGrid(const Scene& scene, bool with_ends) : sector(2.0 * std::numbers::pi / scene.vane.blades) {
  const Vane& vane = scene.vane;
  const double gap = vane.container_radius - vane.radius, arc = sector * vane.radius;
  const int n_gap = cells(gap, scene.model.cell[0], 2);
  cell[0] = gap / n_gap;
  n_blade = std::max(1, static_cast<int>(std::floor(vane.radius / cell[0] * (1.0 + 1e-12))));
  n_radial = n_gap + n_blade;
  inner = std::max(0.0, vane.radius - n_blade * cell[0]);
  n_shaft = std::clamp(static_cast<int>(std::lround((vane.shaft_radius - inner) / cell[0])), 0, n_blade - 1);
  const bool thin = vane.blade_thickness < sheet * scene.model.cell[1];
  n_thick = thin ? 0 : cells(vane.blade_thickness, scene.model.cell[1], 1);
  n_around = thin ? cells(arc, scene.model.cell[1], 4) : n_thick * cells(arc, vane.blade_thickness, 2);
  cell[1] = sector / n_around;
  n_height = cells_along(vane, scene.model.cell[0]);
  cell[2] = vane.height / n_height;
  n_bottom = with_ends ? cells(vane.bottom_gap, cell[2], 1) : 0;
  n_cover = with_ends ? cells(vane.cover, cell[2], 1) : 0;
  if (!with_ends) n_height = 2;
}

SteadyBody steady_body(const Scene& scene, const EndsGrid& g) {
  SteadyBody body;
  body.mix = scene.mix;
  const int first = (g.n_around - g.n_thick) / 2, top = g.n_bottom + g.n_height;
  const bool ends = g.n_bottom > 0;
  auto& axes = body.grid.axes;
  axes[0] = {.h = g.cell[0],
             .origin = g.inner,
             .low = FaceKind::free_slip,
             .high = FaceKind::no_slip,
             .n_cells = g.n_radial,
             .repeated_knots = {g.n_blade}};
  if (g.n_shaft > 0 && g.n_shaft < g.n_blade)
    axes[0].repeated_knots.insert(axes[0].repeated_knots.begin(), g.n_shaft);
  axes[1] = {.h = g.cell[1], .periodic = true, .n_cells = g.n_around, .repeated_knots = {first}};
  if (g.n_thick > 0) axes[1].repeated_knots.push_back(first + g.n_thick);
  axes[2] = {.h = g.cell[2],
             .low = ends ? FaceKind::no_slip : FaceKind::free_slip,
             .high = FaceKind::free_slip,
             .n_cells = top + g.n_cover};
  if (ends) axes[2].repeated_knots = {g.n_bottom, top};
  const int surface = axes[2].n_cells + 1;  // beyond the last face: its nodes are the block's too
  body.grid.blocks = {{{0, first, g.n_bottom}, {g.n_blade, first + g.n_thick, ends ? top : surface}, {}},
                      {{0, 0, g.n_bottom}, {g.n_shaft, g.n_around, surface}, {}}};
  lay_out_steady_flow(body);
  return body;
}

SteadyTorques turn_steadily(const Scene& scene, const EndsGrid& grid, double speed, SteadyBody& body) {
  const double omega = angular_speed(speed);
  for (auto& block : body.grid.blocks)
    block.velocity = [omega](const Vec<3>& x) { return Vec<3>(0.0, omega * x[0], 0.0); };
  SteadyTorques t;
  t.solve = solve_steady_flow(body, scene.model.law, std::abs(omega));
  const auto& axes = body.grid.axes;
  for (int i = 0; i < body.grid.n_nodes(); ++i) {
    const auto& at = body.grid.node_index[i];
    const double moment = scene.vane.blades * body.grid.node_position(i)[0] * body.wall_force[i][1];
    const bool floor = grid.n_bottom > 0 && axes[2].on_low_wall(at[2]);
    (axes[0].on_high_wall(at[0]) || floor ? t.wall : t.blades) +=
        axes[0].on_high_wall(at[0]) || floor ? -moment : moment;
  }
  t.power = scene.vane.blades * body.dissipation / omega;
  return t;
}

Outcome run_with_ends(const Scene& scene, const scene::Observer& observer) {
  const EndsGrid grid(scene, true);
  SteadyBody body = steady_body(scene, grid);
  Outcome outcome;
  double time = 0.0, turned = 0.0, last_speed = 0.0;
  SteadyTorques t;
  const auto stages = lines_of(scene);
  double fastest = 0.0, slowest = 1e300;
  for (const auto& [speed, duration] : stages) {
    if (observer.interrupted && *observer.interrupted) {
      outcome.status = Status::interrupted;
      break;
    }
    if (speed != last_speed) {
      t = turn_steadily(scene, grid, speed, body);
      outcome.checks.unconverged_steps += t.solve.converged ? 0 : 1;
      outcome.cost.steps += 1;
    }
    last_speed = speed, time += duration, turned += angular_speed(speed) * duration;
    fastest = std::max(fastest, std::abs(speed)), slowest = std::min(slowest, std::abs(speed));
    outcome.series.push_back({.time = time,
                              .speed = speed,
                              .torque = t.blades,
                              .torque_wall = t.wall,
                              .torque_power = t.power,
                              .shear_rate_mean = mean_shear_rate(body),
                              .time_step = duration,
                              .iterations = t.solve.iterations});
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
  judge(scene, grid, fastest, slowest, outcome.checks);
  outcome.checks.max_speed_end = angular_speed(std::abs(last_speed)) * scene.vane.radius;
  outcome.results.profile = profile_of(grid, body);
  body = {};  // the plane section takes its place
  outcome.results.torque_plane = plane_torque(scene, last_speed, outcome.checks);
  outcome.results.end_factor = t.blades / *outcome.results.torque_plane;
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
