#pragma once

// The test in one geometry: set up, step until rest, read.

#include "apparatus/parts/boxes/boxes.hpp"
#include "apparatus/parts/boxes/checks.hpp"
#include "apparatus/parts/boxes/pour.hpp"
#include "apparatus/parts/boxes/reading.hpp"
#include "apparatus/parts/boxes/set_up.hpp"
#include "apparatus/run/experiment.hpp"
#include "apparatus/run/passing.hpp"
#include "libmpm/implicit/archived_state.hpp"

namespace tremie::boxes {

inline constexpr double detached_share = 0.005;  ///< share of the points that may fall off the column's walls
inline constexpr double share_of_time = 0.01;    ///< largest step, in the time since the start of the lift
inline constexpr double longest_step = 0.3;      ///< [s]: in longer ones thin films run away

template <class Geometry>
StepSettings step_settings(const Scene& scene) {
  StepSettings settings = experiment::step_settings(scene.model);
  if (!scene.model.time_step) settings.detached = detached_share;
  settings.cut_cell_rule = true;   // what hangs on the column's walls is thinner than a cell
  settings.moving_surface = true;  // without it steps of tenths of a second carry a fluid past its level
  settings.settle_on_floor = Geometry::dim == 3;  // there the cut cells have no rule of their own
  settings.alternating_viscosity = scene.alternating_viscosity;
  settings.wall_law = scene.walls;
  if (scene.model.space == SpaceKind::plane_with_side_walls && face(scene.walls) != FaceKind::free_slip)
    settings.side_wall_distance = scene.box.width;
  return settings;
}

/// The longest step: the films on the column's walls drain ever more slowly, so may the steps go.
inline double longest_dt(const Scene& scene, double time) {
  return scene.model.step_scale * std::clamp(share_of_time * time, StepSettings{}.dt_max, longest_step);
}

template <class Geometry>
void read_results(const Body<Geometry>& body, const Scene& scene, std::optional<double> stopped_at,
                  Outcome& outcome) {
  const Sample &first = outcome.series.front(), &last = outcome.series.back();
  Results& r = outcome.results;
  r.h1 = last.h1;
  r.h2 = last.h2;
  if (last.h2 && last.h1 > 0.0) r.passing_ratio = *last.h2 / last.h1;
  r.ratio_change = ratio_change(outcome.series);
  r.t200 = experiment::time_of_passing(outcome.series, &Sample::front, 0.2);
  r.t400 = experiment::time_of_passing(outcome.series, &Sample::front, 0.4);
  r.stopped_at = stopped_at;
  r.flocculation_mean_start = first.flocculation_mean;
  r.flocculation_mean_end = last.flocculation_mean;
  read_profile(body, scene, r);
}

/// The mass is that which was poured, and what is poured does not fall.
template <class Geometry>
void judge_pour(const Body<Geometry>& body, const Poured& poured, Checks& checks) {
  const double in_points = body.mix.density * (poured.section - poured.waiting);
  checks.mass_error = experiment::total_mass(body.points) / in_points - 1.0;
  checks.stood_still = false;
}

template <class Geometry>
Outcome run_in(const Scene& scene, const scene::Observer& observer, ProgressText text) {
  ImplicitBody<Geometry> body{filled_column<Geometry>(scene)};
  StepSettings settings = step_settings<Geometry>(scene);
  add_bars(scene, body);

  Outcome outcome;
  double through = 0.0;  // gate and front wall, share of the volume
  Poured poured{scene.box.column_length * scene.box.column_height};
  const experiment::Flow flow{
      .time = [&] { return body.time; },
      .unfinished = [&] { return experiment::has_time_left(body.time, scene.duration); },
      .prepare =
          [&] {
            const double left = scene.duration - body.time;
            settings.dt_max =
                std::min(longest_dt(scene, body.time), experiment::without_sliver(left, body.dt));
            settings.fixed_dt = experiment::fixed_step(scene.model, left);
            body.grid.sheets = walls_inside<Geometry>(scene, body.grid.axes[0], body.time);
          },
      .advance =
          [&](Checks& checks, Cost& cost) {
            const auto from = body.points.x;
            const double edge = gate_edge(scene, body.time);
            const StepReport step = implicit_step(body, scene.model.law, settings);
            through += share_through_the_wall(body, from, edge);
            if constexpr (Geometry::dim == 2)
              if (scene.pour && !step.failed) let_in(scene, poured, body);
            experiment::count_step(body, step, checks, cost);
            experiment::watch_fixed_step(body, scene.model, step, checks);
            return step;
          },
      .frame = [&] { return experiment::frame_of(body); },
      // Drops from the films on the column's walls fall long after the concrete stands.
      .speed = [](const StepReport& step) { return step.bulk_speed; },
      .free_to_flow =
          [&] {
            return (!scene.gate_speed || *scene.gate_speed * body.time > scene.box.channel_height) &&
                   (!scene.pour || body.time > scene.pour->time);
          },
      .stands_since = [&] { return Geometry::dim == 3 ? stands_since(outcome.series) : std::nullopt; },
      .state =
          [&](Archive& archive) {
            archive(body, outcome.series, through);
            if (scene.pour) archive(poured.section, poured.waiting);
          }};
  experiment::run_experiment(
      flow, body, {scene.duration, scene.frame_interval, text}, observer,
      [&](const StepReport& step) {
        Sample line = read(body, scene, step);
        line.through_the_wall = through;
        return line;
      },
      [&](std::optional<double> stopped_at) {
        read_results(body, scene, stopped_at, outcome);
        if (scene.pour) judge_pour(body, poured, outcome.checks);
        add_reasons(scene, outcome);
      },
      outcome);
  return outcome;
}

}  // namespace tremie::boxes
