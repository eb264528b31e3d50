#pragma once

// The L-box test in one geometry: set up, step until rest, read.

#include "apparatus/l_box/l_box.hpp"
#include "apparatus/l_box/reading.hpp"
#include "apparatus/l_box/series.hpp"
#include "apparatus/l_box/set_up.hpp"
#include "apparatus/run/frames.hpp"
#include "apparatus/run/run_checks.hpp"
#include "apparatus/run/run_loop.hpp"
#include "apparatus/run/step_settings.hpp"
#include "libmpm/implicit/archived_state.hpp"

namespace tremie::l_box {

inline constexpr double detached_share = 0.005;  ///< share of the points that may fall off the column's walls
inline constexpr double share_of_time = 0.01;    ///< largest step, in the time since the start of the lift
inline constexpr double longest_step = 0.3;      ///< [s]: in longer ones thin films run away

template <class Geometry>
StepSettings step_settings(const Scene& scene) {
  StepSettings settings = test_run::step_settings(scene.model);
  if (!scene.model.time_step) settings.detached = detached_share;
  settings.cut_cell_rule = true;   // what hangs on the column's walls is thinner than a cell
  settings.moving_surface = true;  // without it steps of tenths of a second carry a fluid past its level
  settings.alternating_viscosity = scene.alternating_viscosity;
  if (scene.model.space == SpaceKind::plane_with_side_walls) settings.side_wall_distance = scene.box.width;
  return settings;
}

/// The longest step: the films on the column's walls drain ever more slowly, so may the steps go. In space
/// gravity acts where the surface is at a step's start (libmpm/implicit/free_surface.hpp), and they do not
/// grow.
template <class Geometry>
double longest_dt(const Scene& scene, double time) {
  const double shortest = StepSettings{}.dt_max;
  return scene.model.step_scale *
         (Geometry::dim == 3 ? shortest : std::clamp(share_of_time * time, shortest, longest_step));
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
  r.t200 = time_of_front(outcome.series, 0.2);
  r.t400 = time_of_front(outcome.series, 0.4);
  r.stopped_at = stopped_at;
  r.flocculation_mean_start = first.flocculation_mean;
  r.flocculation_mean_end = last.flocculation_mean;
  read_profile(body, scene, r);
}

/// The drag of a bar between cells that resolve it and those for which it was measured; and a gap wants two cells.
inline void judge_bars(const Scene& scene, const std::vector<Sample>& series, Checks& checks) {
  const double cell = scene.model.cell[0], most = 0.5 * bar_cells_most * bar_diameter;
  const double inertia = scene.bars > 0 ? bar_reynolds(scene, series) : 0.0;
  if (inertia > most_bar_reynolds) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "the bars' drag leaves inertia out, and their Reynolds number is %.3g, more than %g: a stiffer mix",
        inertia, most_bar_reynolds);
    checks.reasons.push_back(text);
  }
  if (scene.bars > 0 && cell > most * (1.0 + 1e-9))
    checks.reasons.push_back("cells of " + std::to_string(std::lround(1e3 * cell)) +
                             " mm are too large for the gaps between the bars: a model.cell of at most " +
                             std::to_string(std::lround(1e3 * most)) + " mm");
}

/// Depths and how far they reach are the grid's where a few cells make them: below these the passing ratio is
/// up to 40 % off (lbox_cells.md).
inline constexpr double least_behind_the_gate = 3.5, least_at_the_end = 1.0, least_along = 3.0;  // [cells]

inline void judge_cells(const Scene& scene, const Results& r, Checks& checks) {
  const auto [across, up] = scene.model.cell;
  char text[160] = "";
  if (r.h1 < least_behind_the_gate * up)
    std::snprintf(text, sizeof text, "the concrete behind the gate is %.2g cells deep, less than %.2g",
                  r.h1 / up, least_behind_the_gate);
  else if (r.h2 && *r.h2 < least_at_the_end * up)
    std::snprintf(text, sizeof text, "the concrete at the channel's end is thinner than a cell, %.3g mm",
                  1e3 * *r.h2);
  else if (scene.box.column_length < least_along * across)
    std::snprintf(text, sizeof text, "the column is %.2g cells long, less than %.2g",
                  scene.box.column_length / across, least_along);
  if (text[0] != 0) checks.reasons.push_back(std::string(text) + ": a smaller model.cell");
}

/// In space a thin bed of a fluid mix may level beyond what its yield stress lets it, on cells with few points, or stop
/// before cells that fast flow left half full have been mended (lbox_bars.md): at 50 Pa the drop is 1.16 times what the
/// yield stress holds, with bars and without, at 20 Pa 1.37 and 1.63 times, and the ratio 0.07 and 0.15 too small.
inline void judge_level(const Scene& scene, const Results& r, Checks& checks) {
  constexpr double least = 0.6, most = 1.3;
  if (!r.h2 || !in_space(scene)) return;
  const Stretch gate = behind_the_gate(scene.box), end = at_the_end(scene.box);
  const double length = 0.5 * (end.low + end.high - gate.low - gate.high);
  const double right = drop_at_rest(scene, 0.5 * (r.h1 + *r.h2), length);
  const double drop = r.h1 - *r.h2;
  const bool stopped_early = r.stopped_at && drop > most * right;
  if (drop >= least * right && !stopped_early) return;
  char text[240];
  std::snprintf(text, sizeof text,
                "the bed %s H1 - H2 = %.2g mm, and its yield stress holds %.2g mm: %smodel.space = "
                "\"plane_with_side_walls\" tells such fluid mixes better",
                stopped_early ? "stopped at" : "has levelled to", 1e3 * drop, 1e3 * right,
                stopped_early ? "cells at the channel's end are not full; " : "");
  checks.reasons.push_back(text);
}

template <class Geometry>
Outcome run_in(const Scene& scene, const Observer& observer) {
  ImplicitBody<Geometry> body{filled_column<Geometry>(scene)};
  StepSettings settings = step_settings<Geometry>(scene);
  if constexpr (Geometry::dim == 3)
    if (!resolves_bars(body.grid.axes[1].h)) body.bars = slender_bars(scene, body.grid.axes);
  const double start_mass = test_run::total_mass(body.points);

  Outcome outcome;
  outcome.series.push_back(read(body, scene, {}));
  if (observer.on_frame && !goes_on(observer.checkpoints)) observer.on_frame(test_run::frame_of(body));
  const test_run::Flow flow{
      .time = [&] { return body.time; },
      .unfinished = [&] { return body.time < scene.duration * (1.0 - 1e-12); },
      .prepare =
          [&] {
            const double left = scene.duration - body.time;
            settings.dt_max =
                std::min(longest_dt<Geometry>(scene, body.time), test_run::without_sliver(left, body.dt));
            settings.fixed_dt = test_run::fixed_step(scene.model, left);
            body.boundary = walls_inside<Geometry>(scene, body.grid.axes, body.time);
          },
      .advance =
          [&](Checks& checks, Cost& cost) {
            const StepReport step = implicit_step(body, scene.model.law, settings);
            test_run::count_step(body, step, checks, cost);
            test_run::watch_fixed_step(body, scene.model, step, checks);
            return step;
          },
      .read =
          [&](const StepReport& step) {
            outcome.series.push_back(read(body, scene, step));
            if (observer.on_step) observer.on_step(outcome.series.back());
          },
      .frame = [&] { return test_run::frame_of(body); },
      // Drops from the films on the column's walls fall long after the concrete stands.
      .speed = [](const StepReport& step) { return step.bulk_speed; },
      .free_to_flow =
          [&] { return !scene.gate_speed || *scene.gate_speed * body.time > scene.box.channel_height; },
      .stands_since = [&] { return Geometry::dim == 3 ? stands_since(outcome.series) : std::nullopt; },
      .state = [&](Archive& archive) { archive(body, outcome.series); }};
  const auto stopped_at =
      test_run::run_loop(flow,
                         {observer.on_frame, observer.interrupted, scene.frame_interval,
                          test_run::frame_after(0.0, scene.frame_interval), observer.checkpoints},
                         outcome.status, outcome.checks, outcome.cost);

  read_results(body, scene, stopped_at, outcome);
  test_run::judge(body, start_mass, outcome.checks, outcome.cost);
  test_run::judge_volume(outcome.series.front().volume_change, outcome.checks);
  judge_bars(scene, outcome.series, outcome.checks);
  judge_cells(scene, outcome.results, outcome.checks);
  if (outcome.status == Status::completed) judge_level(scene, outcome.results, outcome.checks);
  outcome.final_frame = test_run::frame_of(body);
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  return outcome;
}

}  // namespace tremie::l_box
