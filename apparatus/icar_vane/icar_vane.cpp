#include "apparatus/icar_vane/icar_vane.hpp"

#include "apparatus/icar_vane/readings.hpp"
#include "apparatus/icar_vane/sections.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double largest_dt = 0.02;  // resolves the decay: lambda follows the flow by one step [s]
constexpr double reach = 1.2;  // of a step, in cells: points move along arcs, without error in a whole turn

/// A speed held for a time.
struct Stage {
  double speed = 0.0, duration = 0.0;  // [rev/s], [s]
};

std::vector<Stage> schedule(const Scene& scene) {
  if (scene.speeds.empty()) return {{scene.speed, scene.duration}};
  std::vector<Stage> stages = {{scene.pre_shear_speed, scene.pre_shear_time}};
  for (double speed : scene.speeds) stages.push_back({speed, scene.hold_time});
  return stages;
}

double angular(double revolutions_per_second) { return 2.0 * std::numbers::pi * revolutions_per_second; }

template <class Section>
Sample read(const Body<typename Section::Geometry>& body, const Scene& scene, const Torques& t,
            double last_momentum, double speed, const StepReport& step) {
  const double h = scene.vane.height;
  Sample s;
  s.time = body.time;
  s.speed = speed;
  s.torque = h * t.blades;
  s.torque_wall = h * t.wall;
  s.torque_power = speed != 0.0 ? h * t.power / angular(speed) : 0.0;
  s.momentum_rate = step.dt > 0.0 ? h * (t.angular_momentum - last_momentum) / step.dt : 0.0;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = engine::mean_flocculation(body.points);
  s.flocculation_apparent = apparent_flocculation(scene, s.torque, speed);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  return s;
}

/// Means over rings one cell wide.
template <class Section>
std::vector<ProfilePoint> profile(const Body<typename Section::Geometry>& body, const Section& section,
                                  double cell) {
  const Vane& vane = section.vane;
  const auto& points = body.points;
  const std::vector<double> gamma_dot = engine::shear_rates_now(body);
  const std::size_t n = static_cast<std::size_t>(std::ceil(vane.container_radius / cell));
  std::vector<double> V(n, 0.0), v(n, 0.0), g(n, 0.0), l(n, 0.0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::size_t k = std::min(n - 1, static_cast<std::size_t>(section.radius(points.x[p]) / cell));
    V[k] += points.volume(p);
    v[k] += points.volume(p) * section.speed(points.x[p], points.v[p]);
    g[k] += points.volume(p) * gamma_dot[p];
    if (points.thixotropic()) l[k] += points.volume(p) * points.lambda[p];
  }
  std::vector<ProfilePoint> out;
  for (std::size_t k = 0; k < n; ++k) {
    if (V[k] <= 0.0) continue;
    ProfilePoint point{(static_cast<double>(k) + 0.5) * cell, v[k] / V[k], g[k] / V[k]};
    if (points.thixotropic()) point.flocculation = l[k] / V[k];
    out.push_back(point);
  }
  return out;
}

template <class Section>
Outcome run_section(const Scene& scene, const Section& section, const Observer& observer) {
  using Geometry = typename Section::Geometry;
  ImplicitBody<Geometry> body{section.body_at_rest(scene)};
  engine::rest(body, scene.rest);
  StepSettings settings = engine::step_settings(scene.model);
  settings.keep_forces = true;
  settings.cfl = reach;
  const double start_mass = engine::total_mass(body.points);

  Outcome outcome;
  double turned = 0.0, last_speed = 0.0, momentum = 0.0, stage_start = 0.0, next_frame = 0.0;
  for (const Stage& stage : schedule(scene)) {
    const double stage_end = stage_start + stage.duration;
    body.dt = first_dt;
    while (body.time < stage_end * (1.0 - 1e-12) && outcome.status == Status::completed) {
      const double left = stage_end - body.time;
      settings.dt_max = left / std::ceil(left / (scene.model.step_scale * largest_dt) - 1e-9);
      const double speed = last_speed + start_up(body.time - stage_start) * (stage.speed - last_speed);
      section.turn(body, angular(speed));
      const StepReport step = implicit_step(body, scene.model.law, settings);
      turned += angular(speed) * step.dt;
      const Torques t = section.torques(body);
      engine::count_step(body, step, outcome.checks, outcome.cost);
      if (engine::gave_up(step, outcome.status, outcome.checks, body.time)) break;
      outcome.series.push_back(read<Section>(body, scene, t, momentum, speed, step));
      momentum = t.angular_momentum;
      if (observer.on_step) observer.on_step(outcome.series.back());
      if (observer.on_frame && body.time >= next_frame) {
        observer.on_frame(section.whole(engine::frame_of(body), turned));
        next_frame += scene.frame_interval;
      }
      if (observer.interrupted && *observer.interrupted) outcome.status = Status::interrupted;
    }
    last_speed = stage.speed;
    stage_start = stage_end;
  }
  engine::judge(body, start_mass, outcome.checks, outcome.cost);
  outcome.results.profile = profile(body, section, scene.model.cell[0]);
  read_instrument(scene, outcome);
  check_torques_agree(scene, outcome);
  check_against_reference(scene, outcome);
  outcome.final_frame = section.whole(engine::frame_of(body), turned);
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  return outcome;
}

void refuse_what_has_no_engine(const Scene& scene) {
  if (scene.model.space != SpaceKind::couette && scene.model.space != SpaceKind::plane)
    throw std::invalid_argument("model.space: the vane runs in \"couette\" or \"plane\"");
  engine::refuse_what_has_no_engine(scene.model, "vane");
}

/// Calls use(section) with the section that the scene names.
template <class Use>
auto with_section(const Scene& scene, Use use) {
  if (scene.model.space == SpaceKind::couette) return use(CouetteSection{scene.vane});
  return use(PlaneSection(scene));
}

}  // namespace

Outcome run(const Scene& scene, const Observer& observer) {
  refuse_what_has_no_engine(scene);
  omp_set_num_threads(scene.threads);
  return with_section(scene, [&](const auto& section) {
    return run_section(scene, section, observer);
  });
}

Estimate estimate(const Scene& scene) {
  refuse_what_has_no_engine(scene);
  return with_section(scene, [&](const auto& section) {
    auto body = section.body_at_rest(scene);
    activate(body.grid, body.points.x);
    Estimate e;
    e.points = static_cast<std::int64_t>(body.points.size());
    e.cells_active = body.grid.n_cells();
    e.bytes_per_point =
        bytes_per_point<std::decay_t<decltype(section)>::Geometry::dim>(scene.mix.thixotropy.has_value());
    for (const Stage& stage : schedule(scene)) e.steps += std::llround(stage.duration / largest_dt) + 15;
    return e;
  });
}

}  // namespace tremie::icar_vane
