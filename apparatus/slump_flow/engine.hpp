#pragma once

// The slump-flow test in an axisymmetric section for one yield law: set up, step until rest, read.

#include <algorithm>
#include <cmath>

#include "apparatus/slump_flow/cone.hpp"
#include "apparatus/slump_flow/reading.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"
#include "libmpm/step/implicit_step.hpp"

namespace tremie::slump_flow {

inline constexpr double gravity = 9.81;            ///< [m/s^2]
inline constexpr double rest_speed = 1e-4;         ///< slower than this is at rest [m/s]
inline constexpr double rest_must_last = 0.5;      ///< before a flow is called stopped [s]
inline constexpr double standard_t500 = 0.5;       ///< diameter of the t500 circle [m]

inline FaceKind face_of(ContactKind contact) {
  return contact == ContactKind::no_slip    ? FaceKind::no_slip
         : contact == ContactKind::friction ? FaceKind::friction
                                            : FaceKind::free_slip;
}

/// The filled cone after its rest, before the lift.
inline Body<Axisymmetric> filled_cone(const Scene& scene) {
  Body<Axisymmetric> body;
  body.mix = scene.mix;
  body.gravity = {0.0, -gravity};
  const auto [across, up] = scene.model.cell;
  body.grid.axes[0] = {.h = across, .low = FaceKind::free_slip};
  body.grid.axes[1] = {.h = up, .low = face_of(scene.floor.contact)};
  const auto [n_across, n_up] = scene.model.points_per_cell;
  fill(scene.cone, scene.mix, gravity, across / n_across, up / n_up, body.points);
  if (scene.mix.thixotropy) {
    const Thixotropy& t = *scene.mix.thixotropy;
    body.points.lambda.assign(body.points.size(),
                              flocculation_after_rest(t.initial_flocculation, t, scene.mix.tau_0, scene.rest));
    body.points.gamma_dot.assign(body.points.size(), 0.0);
  }
  return body;
}

inline StepSettings step_settings(const Scene& scene) {
  StepSettings settings;
  settings.method = scene.model.method == MethodKind::admm     ? YieldMethod::admm
                    : scene.model.method == MethodKind::newton ? YieldMethod::newton
                                                               : YieldMethod::automatic;
  settings.transfer.flip = scene.model.transfer == TransferKind::flip;
  settings.transfer.flip_blend = scene.model.flip_blend;
  settings.fixed_dt = scene.model.time_step;
  settings.friction_coefficient = scene.floor.coefficient;
  settings.wall_gap = 0.5 * scene.model.cell[0] / scene.model.points_per_cell[0];
  return settings;
}

inline Sample read(const Body<Axisymmetric>& body, const StepReport& step) {
  const Points<2>& points = body.points;
  Sample s;
  s.time = body.time;
  s.spread = spread(points, body.grid.axes[0].h);
  s.spread_max_point = spread_of_outermost_point(points);
  s.height = centre_height(points, 2.0 * body.grid.axes[0].h);
  s.max_speed = step.max_speed;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = mean_flocculation(points);
  s.volume_change = volume_change(points);
  s.kinetic_energy = kinetic_energy(points);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  return s;
}

inline Frame frame_of(const Body<Axisymmetric>& body) {
  const Points<2>& points = body.points;
  Frame frame;
  frame.time = body.time;
  for (std::size_t p = 0; p < points.size(); ++p) {
    frame.position.push_back({points.x[p][0], 0.0, points.x[p][1]});
    frame.velocity.push_back({points.v[p][0], 0.0, points.v[p][1]});
    frame.volume.push_back(points.volume(p));
    frame.pressure.push_back(pressure(points.ln_J[p], body.mix.K));
  }
  frame.flocculation = points.lambda;
  frame.shear_rate.assign(points.size(), 0.0);
  if (!body.v.empty()) shear_rate_at_points<Axisymmetric>(body.grid, body.v, points, frame.shear_rate);
  return frame;
}

/// Watches for the flow to come to rest: slow, for long enough, and clear of the cone.
struct RestWatch {
  std::optional<double> slow_since;

  bool at_rest(const Scene& scene, const Sample& s) {
    const bool clear = !scene.lift_speed || rim_height(scene, s.time) > s.height + scene.model.cell[1];
    if (!clear || s.max_speed > rest_speed) slow_since.reset();
    else if (!slow_since) slow_since = s.time;
    return slow_since && s.time - *slow_since >= rest_must_last;
  }
};

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

inline void read_results(const RestWatch& watch, bool stopped, Outcome& outcome) {
  const Sample &first = outcome.series.front(), &last = outcome.series.back();
  Results& r = outcome.results;
  r.spread = last.spread;
  r.spread_max_point = last.spread_max_point;
  r.height = last.height;
  r.flocculation_mean_start = first.flocculation_mean;
  r.flocculation_mean_end = last.flocculation_mean;
  for (const Sample& s : outcome.series) r.shear_rate_mean_peak = std::max(r.shear_rate_mean_peak, s.shear_rate_mean);
  if (stopped) r.stopped_at = watch.slow_since;
  if (stopped && *r.stopped_at > 0.0) r.mean_velocity = (r.spread - 0.2) / (2.0 * *r.stopped_at);
  read_t500(outcome);
}

inline void judge(const Body<Axisymmetric>& body, double start_mass, Outcome& outcome) {
  Checks& c = outcome.checks;
  c.volume_change = outcome.series.back().volume_change;
  c.mass_error = total_mass(body.points) / start_mass - 1.0;
  c.points_lost = points_lost(body.points);
  c.max_speed_end = outcome.series.back().max_speed;
  if (c.unconverged_steps > 0)
    c.reasons.push_back(std::to_string(c.unconverged_steps) + " steps did not converge to the tolerance");
  if (c.points_lost > 0) c.reasons.push_back(std::to_string(c.points_lost) + " points left the domain");
}

template <class Law>
Outcome run_axisymmetric(const Scene& scene, const Law& law, const Observer& observer) {
  Body<Axisymmetric> body = filled_cone(scene);
  StepSettings settings = step_settings(scene);
  const double start_mass = total_mass(body.points);
  const double reach = settings.wall_gap + settings.cfl * scene.model.cell[0];
  const RigidWall<2> wall = scene.lift_speed ? lifted_wall(scene, reach) : RigidWall<2>{};

  Outcome outcome;
  outcome.series.push_back(read(body, {}));
  if (observer.on_frame) observer.on_frame(frame_of(body));
  RestWatch watch;
  bool stopped = false;
  double next_frame = scene.frame_interval;
  while (!stopped && body.time < scene.duration * (1.0 - 1e-12)) {
    settings.dt_max = std::min(StepSettings{}.dt_max, scene.duration - body.time);
    const bool cone_gone = scene.lift_speed && rim_height(scene, body.time) > outcome.series.back().height + 0.02;
    const StepReport step = implicit_step(body, law, settings, cone_gone ? RigidWall<2>{} : wall);
    outcome.checks.unconverged_steps += step.converged ? 0 : 1;
    outcome.cost.steps += 1;
    outcome.cost.cells_active = std::max<std::int64_t>(outcome.cost.cells_active, body.grid.n_cells());
    outcome.series.push_back(read(body, step));
    if (observer.on_step) observer.on_step(outcome.series.back());
    if (observer.on_frame && body.time >= next_frame) {
      observer.on_frame(frame_of(body));
      next_frame += scene.frame_interval;
    }
    stopped = watch.at_rest(scene, outcome.series.back());
    if (observer.interrupted && *observer.interrupted) {
      outcome.status = Status::interrupted;
      break;
    }
  }
  read_results(watch, stopped, outcome);
  judge(body, start_mass, outcome);
  outcome.cost.points = static_cast<std::int64_t>(body.points.size());
  outcome.cost.bytes_per_point = bytes_per_point<2>(body.points.thixotropic());
  outcome.cost.simulated = body.time;
  outcome.final_frame = frame_of(body);
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  return outcome;
}

}  // namespace tremie::slump_flow
