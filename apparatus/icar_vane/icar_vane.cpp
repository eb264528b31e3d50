#include "apparatus/icar_vane/icar_vane.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apparatus/icar_vane/ends.hpp"
#include "apparatus/icar_vane/instrument.hpp"
#include "apparatus/icar_vane/sections.hpp"
#include "apparatus/run/experiment.hpp"
#include "libmpm/implicit/archived_state.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double largest_dt = 0.02;  // resolves the decay: lambda follows the flow by one step [s]
constexpr double slow_tolerance =
    1e-4;  // of the yield solver where a layer is given: a slow vane's rates are small
constexpr double share_at_rest = 0.1;  // of the slowest nominal shear rate: rates below are at rest
constexpr double reach = 1.2;  // of a step, in cells: points move along arcs, without error in a whole turn

template <class Section>
Sample read(const Body<typename Section::Geometry>& body, const Scene& scene, const Torques& t,
            double last_momentum, double speed, const StepReport& step) {
  const double h = scene.vane.height;
  Sample s;
  s.time = body.time;
  s.speed = speed;
  s.torque = h * t.blades;
  s.torque_wall = h * t.wall;
  s.torque_power = speed != 0.0 ? h * t.power / angular_speed(speed) : 0.0;
  s.momentum_rate = step.dt > 0.0 ? h * (t.angular_momentum - last_momentum) / step.dt : 0.0;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = experiment::mean_flocculation(body.points);
  s.flocculation_apparent = apparent_flocculation(scene, s.torque, speed);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  s.slip = t.slip;
  return s;
}

/// Means over rings one cell wide.
template <class Section>
std::vector<ProfilePoint> profile(const Body<typename Section::Geometry>& body, const Section& section,
                                  double cell) {
  const Vane& vane = section.vane;
  const auto& points = body.points;
  const std::vector<double> gamma_dot = experiment::shear_rates_now(body);
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

/// Where in its schedule a test is: the stages follow one another, and the speed changes evenly at the start
/// of each.
struct Schedule {
  std::vector<Stage> stages;
  std::size_t at = 0;
  double stage_start = 0.0, last_speed = 0.0;  ///< [s], [rev/s]

  double stage_end() const { return stage_start + stages[at].duration; }
  bool stage_over(double time) const { return !(time < stage_end() * (1.0 - 1e-12)); }

  /// Goes to the stage of this time; true where it is a new one. There is none left at the end.
  bool follow(double time) {
    bool changed = false;
    for (; at < stages.size() && stage_over(time); ++at, changed = true) {
      last_speed = stages[at].speed;
      stage_start = stage_end();
    }
    return changed;
  }
  double speed(double time) const {
    return last_speed + start_up(time - stage_start) * (stages[at].speed - last_speed);
  }
};

/// Nominal shear rate of the slowest speed that is not 0 [1/s].
double slowest_rate(const Scene& scene) {
  double slowest = std::numeric_limits<double>::infinity();
  for (const Stage& stage : stages_of(scene))
    if (stage.speed != 0.0) slowest = std::min(slowest, std::abs(stage.speed));
  return newtonian_shear_rate(angular_speed(slowest),
                              {scene.vane.radius, scene.vane.height, scene.vane.container_radius});
}

template <class Section>
Outcome run_section(const Scene& scene, const Section& section, const scene::Observer& observer) {
  using Geometry = typename Section::Geometry;
  ImplicitBody<Geometry> body{section.body_at_rest(scene)};
  experiment::rest(body, scene.rest);
  StepSettings settings = experiment::step_settings(scene.model);
  settings.keep_forces = true;
  settings.wall_law = scene.walls;
  settings.cfl = reach;
  settings.admm.rate_at_rest = std::min(settings.admm.rate_at_rest, share_at_rest * slowest_rate(scene));
  if (scene.mix.thixotropy && scene.mix.thixotropy->layer > 0.0) settings.admm.tolerance = slow_tolerance;

  Outcome outcome;
  double turned = 0.0, speed = 0.0, momentum = 0.0;
  Schedule schedule{stages_of(scene)};
  body.dt = first_dt;
  const experiment::Flow flow{.time = [&] { return body.time; },
                              .unfinished =
                                  [&] {
                                    if (schedule.follow(body.time)) body.dt = first_dt;
                                    return schedule.at < schedule.stages.size();
                                  },
                              .prepare =
                                  [&] {
                                    const double left = schedule.stage_end() - body.time;
                                    settings.dt_max =
                                        left / std::ceil(left / (scene.model.step_scale * largest_dt) - 1e-9);
                                    settings.fixed_dt = experiment::fixed_step(scene.model, left);
                                    speed = schedule.speed(body.time);
                                    section.turn(body, angular_speed(speed));
                                  },
                              .advance =
                                  [&](Checks& checks, Cost& cost) {
                                    const StepReport step = implicit_step(body, scene.model.law, settings);
                                    turned += angular_speed(speed) * step.dt;
                                    experiment::count_step(body, step, checks, cost);
                                    return step;
                                  },
                              .frame = [&] { return section.whole(experiment::frame_of(body), turned); },
                              .state =
                                  [&](Archive& archive) {
                                    archive(body, turned, momentum, outcome.series);
                                    archive(schedule.at, schedule.stage_start, schedule.last_speed);
                                  }};
  experiment::run_experiment(
      flow, body, {whole_time(scene), scene.frame_interval, progress_text, /*from_start=*/false}, observer,
      [&](const StepReport& step) {
        const Torques t = section.torques(body);
        const Sample sample = read<Section>(body, scene, t, momentum, speed, step);
        momentum = t.angular_momentum;
        return sample;
      },
      [&](std::optional<double>) {
        outcome.results.profile = profile(body, section, scene.model.cell[0]);
        read_and_check(scene, outcome);
      },
      outcome);
  return outcome;
}

void refuse_what_has_no_engine(const Scene& scene) {
  const bool ends = scene.model.space == SpaceKind::cylindrical;
  if (scene.model.space != SpaceKind::couette && scene.model.space != SpaceKind::plane && !ends)
    throw std::invalid_argument("model.space: the vane runs in \"couette\", \"plane\" or \"cylindrical\"");
  if (ends && scene.mix.thixotropy)
    throw std::invalid_argument(
        "model.space: \"cylindrical\" is steady flow, without flocculation that the concrete carries along; "
        "allowed with mix.thixotropy: \"couette\", \"plane\"; or leave it out by --set mix.thixotropy=false");
  if (ends && scene.model.method == MethodKind::newton)
    throw std::invalid_argument("model.method: \"cylindrical\" runs with \"auto\" or \"admm\"");
  experiment::refuse_what_has_no_engine(scene.model, "vane");
  constexpr double most = 1e7;  // some 10 GB in a section
  const auto [n, n_around] = scene.model.points_per_cell;
  const double across = scene.vane.container_radius / scene.model.cell[0] * n;
  const double around = std::numbers::pi * scene.vane.container_radius / scene.model.cell[1] * n_around;
  if ((scene.model.space == SpaceKind::couette ? across : across * around / scene.vane.blades) > most)
    throw std::invalid_argument("model.cell: more than 10,000,000 points in a section; larger cells");
}

/// Calls use(section) with the section that the scene names.
template <class Use>
auto with_section(const Scene& scene, Use use) {
  if (scene.model.space == SpaceKind::couette) return use(CouetteSection{scene.vane});
  const PlaneSection section(scene);
  if (section.shaft <= 0.0)
    throw std::invalid_argument("model.cell: two cells are longer than the blades; smaller ones");
  return use(section);
}

}  // namespace

double whole_time(const Scene& scene) {
  if (scene.speeds.empty()) return scene.duration;
  return scene.pre_shear_time + static_cast<double>(scene.speeds.size()) * scene.hold_time;
}

Outcome run(const Scene& scene, const scene::Observer& observer) {
  refuse_what_has_no_engine(scene);
  omp_set_num_threads(scene.threads);
  if (scene.model.space == SpaceKind::cylindrical) return run_with_ends(scene, observer);
  return with_section(scene, [&](const auto& section) { return run_section(scene, section, observer); });
}

scene::SizeEstimate estimate(const Scene& scene) {
  refuse_what_has_no_engine(scene);
  if (scene.model.space == SpaceKind::cylindrical) return estimate_with_ends(scene);
  return with_section(scene, [&](const auto& section) {
    auto body = section.body_at_rest(scene);
    activate(body.grid, body.points.x);
    scene::SizeEstimate e;
    e.points = static_cast<std::int64_t>(body.points.size());
    e.cells_active = body.grid.n_cells();
    e.bytes_per_point =
        bytes_per_point<std::decay_t<decltype(section)>::Geometry::dim>(lambda_numbers(scene.mix));
    for (const Stage& stage : stages_of(scene)) {
      e.steps += experiment::whole_steps(stage.duration / largest_dt) + 15;
      e.time_expected += stage.duration;
    }
    e.steps_expected = e.steps;
    // Steady flows of the couette section converge at once, a decay does not.
    const double couette = scene.mix.thixotropy ? 0.9e-6 : 0.2e-6;
    e.point_step = scene.model.space == SpaceKind::couette ? couette : 1.9e-6;
    return e;
  });
}

}  // namespace tremie::icar_vane
