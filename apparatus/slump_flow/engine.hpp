#pragma once

// The slump-flow test in an axisymmetric section or in space for one yield law: set up, step until rest,
// read.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "apparatus/common/run.hpp"
#include "apparatus/slump_flow/cone.hpp"
#include "apparatus/common/energy_watch.hpp"
#include "apparatus/slump_flow/reading.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::slump_flow {

using engine::gravity;

inline constexpr double standard_t500 = 0.5;  ///< diameter of the t500 circle [m]

/// Whether only the first quadrant is computed, between planes of symmetry.
inline bool is_quarter(const Scene& scene) { return scene.model.space == SpaceKind::quarter; }

/// The filled cone after its rest, before the lift.
template <class Geometry>
Body<Geometry> filled_cone(const Scene& scene) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  Body<Geometry> body;
  body.mix = scene.mix;
  body.gravity[up] = -gravity;
  const auto [h, h_up] = scene.model.cell;
  // Explicit steps have no mirrored splines: their planes of symmetry are slippery walls.
  const FaceKind plane =
      scene.model.scheme == SchemeKind::implicit ? FaceKind::symmetry : FaceKind::free_slip;
  for (int d = 0; d < up; ++d)
    body.grid.axes[d] = {.h = h,
                         .low = D == 2              ? FaceKind::free_slip
                                : is_quarter(scene) ? plane
                                                    : FaceKind::open};
  body.grid.axes[up] = {.h = h_up, .low = engine::face_of(scene.floor.contact)};
  const auto [n, n_up] = scene.model.points_per_cell;
  if constexpr (D == 2)
    fill(scene.cone, scene.mix, gravity, h / n, h_up / n_up, body.points);
  else
    fill(scene.cone, scene.mix, gravity, h / n, h_up / n_up, is_quarter(scene), body.points);
  shrink(body.points);
  engine::rest(body, scene.rest);
  return body;
}

inline StepSettings step_settings(const Scene& scene) {
  StepSettings settings = engine::step_settings(scene.model);
  if (scene.model.space != SpaceKind::axisymmetric) settings.time_error = 0.005;
  settings.friction_coefficient = scene.floor.coefficient;
  settings.wall_gap = 0.5 * scene.model.cell[0] / scene.model.points_per_cell[0];
  return settings;
}

inline double spread_of(const Scene& scene, const Points<2>& points) {
  return spread(points, scene.model.cell[0]);
}
inline double spread_of(const Scene& scene, const Points<3>& points) {
  return spread(points, scene.model.cell[0], is_quarter(scene));
}

template <class Geometry>
Sample read(const Scene& scene, const Body<Geometry>& body, const StepReport& step) {
  const auto& points = body.points;
  Sample s;
  s.time = body.time;
  s.spread = spread_of(scene, points);
  s.spread_max_point = spread_of_outermost_point(points);
  s.height = centre_height(points, 2.0 * body.grid.axes[0].h);
  s.max_speed = step.max_speed;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = engine::mean_flocculation(points);
  s.volume_change = engine::volume_change(points);
  s.kinetic_energy = (is_quarter(scene) ? 4.0 : 1.0) * engine::kinetic_energy(points);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  return s;
}

inline void read_t500(Outcome& outcome) {
  const auto& series = outcome.series;
  for (std::size_t i = 1; i < series.size(); ++i) {
    const Sample &a = series[i - 1], &b = series[i];
    if (b.spread < standard_t500) continue;
    const double share = (standard_t500 - a.spread) / (b.spread - a.spread);
    outcome.results.t500 = a.time + std::clamp(share, 0.0, 1.0) * (b.time - a.time);
    return;
  }
}

inline void read_results(const engine::RestWatch& watch, bool stopped, Outcome& outcome) {
  const Sample &first = outcome.series.front(), &last = outcome.series.back();
  Results& r = outcome.results;
  r.spread = last.spread;
  r.spread_max_point = last.spread_max_point;
  r.height = last.height;
  r.flocculation_mean_start = first.flocculation_mean;
  r.flocculation_mean_end = last.flocculation_mean;
  for (const Sample& s : outcome.series)
    r.shear_rate_mean_peak = std::max(r.shear_rate_mean_peak, s.shear_rate_mean);
  if (stopped) r.stopped_at = watch.slow_since;
  if (stopped && *r.stopped_at > 0.0) r.mean_velocity = (r.spread - 0.2) / (2.0 * *r.stopped_at);
  read_t500(outcome);
}

/// Whether the floor bears less than shears the body, which then slides: at most the friction of its weight
/// over its area. A regularised law is sheared by any stress; flocculation only adds to the yield stress.
inline bool slides(const Scene& scene, double depth) {
  if (scene.floor.contact != ContactKind::friction) return scene.floor.contact == ContactKind::free_slip;
  const double shears = is_exact(scene.model.law) ? scene.mix.tau_0 : 0.0;
  return scene.floor.coefficient * scene.mix.density * gravity * depth <= shears;
}

/// Between the floor that holds it and its free surface a body thinner than a cell has no rows of cells to
/// shear: its spread is up to 20 % off (explicit.md). One that slides need not shear: 6 % from half a cell
/// on.
inline void judge_depth(const Scene& scene, Outcome& outcome) {
  const double R = 0.5 * outcome.results.spread, depth = volume(scene.cone) / (std::numbers::pi * R * R);
  const bool sliding = slides(scene, depth);
  const double least = (sliding ? 0.5 : 1.0) * scene.model.cell[1];
  if (depth >= least) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the concrete is thinner than %s, %.3g mm on average: a smaller model.cell upwards",
                sliding ? "half a cell" : "a cell", 1e3 * depth);
  outcome.checks.reasons.push_back(text);
}

/// Concrete that presses on the cone for long goes through its wall, and the opening under a rim that has not
/// risen by a cell is none to the grid. Where a twentieth has by then, t500 is 6 % early (lift.md).
inline void judge_lift(Outcome& outcome) {
  constexpr double most = 0.05;
  const auto& through = outcome.results.through_the_cone;
  if (!through || *through <= most) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "%.2g %% of the concrete went through the cone's wall before its rim had risen by a cell: a "
                "faster test.lift_speed, or a smaller model.cell",
                100.0 * *through);
  outcome.checks.reasons.push_back(text);
}

inline void lifted_wall(const Scene& scene, double reach, RigidWall<2>& wall) {
  wall = lifted_wall(scene, reach);
}
inline void lifted_wall(const Scene& scene, double reach, RigidWall<3>& wall) {
  wall = revolved(lifted_wall(scene, reach));
}

/// Adds a line to the series. True where the flow has come to rest, clear of the cone; an interrupt sets the
/// outcome's status.
template <class Geometry>
bool record(const Scene& scene, const Body<Geometry>& body, const StepReport& step, const Observer& observer,
            engine::RestWatch& watch, Outcome& outcome) {
  const bool low = scene.lift_speed && rim_height(scene, outcome.series.back().time) < scene.model.cell[1];
  if (low) outcome.results.through_the_cone = share_behind_wall(scene, body.time, body.points);
  outcome.series.push_back(read(scene, body, step));
  const Sample& now = outcome.series.back();
  if (observer.on_step) observer.on_step(now);
  if (observer.interrupted && *observer.interrupted) outcome.status = Status::interrupted;
  const bool clear = !scene.lift_speed || rim_height(scene, now.time) > now.height + scene.model.cell[1];
  return watch.at_rest(clear, now.max_speed, now.time);
}

/// In space a body that flows is solved with less exact stresses, four thousandths instead of one: half of
/// the cost, and a spread that differs by less than half a millimetre (three_d.md). One that creeps is not,
/// or what they leave would keep it from coming to rest.
inline constexpr double flowing_tolerance = 4e-3, creeping = 1e-3;  // [1], [m/s]

template <class Geometry>
Outcome run_in(const Scene& scene, const Observer& observer) {
  ImplicitBody<Geometry> body{filled_cone<Geometry>(scene)};
  StepSettings settings = step_settings(scene);
  const double start_mass = engine::total_mass(body.points);
  const double reach = settings.wall_gap + settings.cfl * scene.model.cell[0];
  RigidWall<Geometry::dim> wall;
  if (scene.lift_speed) lifted_wall(scene, reach, wall);

  Outcome outcome;
  outcome.series.push_back(read(scene, body, {}));
  if (observer.on_frame) observer.on_frame(engine::frame_of(body));
  EnergyWatch energy(energy_of<Geometry>(body.points, body.mix.K));
  engine::RestWatch watch;
  bool stopped = false, flows = true;
  double next_frame = scene.frame_interval;
  while (!stopped && body.time < scene.duration * (1.0 - 1e-12)) {
    settings.time_left = scene.duration - body.time;
    if constexpr (Geometry::dim == 3)
      settings.admm.tolerance = flows ? flowing_tolerance : StepSettings{}.admm.tolerance;
    const bool cone_gone =
        scene.lift_speed && rim_height(scene, body.time) > outcome.series.back().height + 0.02;
    const StepReport step = implicit_step(body, scene.model.law, settings, cone_gone ? RigidWall<Geometry::dim>{} : wall);
    flows = step.bulk_speed > creeping;
    engine::count_step(body, step, outcome.checks, outcome.cost);
    engine::watch_fixed_step(body, scene.model, step, outcome.checks);
    if (engine::gave_up(step, outcome.status, outcome.checks, body.time)) break;
    // What is elastic in it a body may turn into motion later: it counts for what it may have, not for what
    // it has.
    const bool pushed = wall && !cone_gone;
    energy.see(pushed ? energy_of<Geometry>(body.points, body.mix.K) : energy_of_motion<Geometry>(body.points),
               pushed);
    stopped = record(scene, body, step, observer, watch, outcome);
    if (energy.ran_away()) outcome.status = Status::failed;
    if (observer.on_frame && body.time >= next_frame) {
      observer.on_frame(engine::frame_of(body));
      next_frame += scene.frame_interval;
    }
    if (outcome.status != Status::completed) break;
  }
  read_results(watch, stopped, outcome);
  energy.tell(outcome.checks);
  engine::judge(body, start_mass, outcome.checks, outcome.cost);
  engine::judge_volume(outcome.series.front().volume_change, outcome.checks);
  judge_depth(scene, outcome);
  judge_lift(outcome);
  outcome.final_frame = engine::frame_of(body);
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  return outcome;
}

}  // namespace tremie::slump_flow
