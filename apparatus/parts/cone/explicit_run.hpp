#pragma once

// The slump-flow test by explicit steps: many short ones between two readings.

#include <fmt/format.h>

#include "apparatus/parts/cone/checks.hpp"
#include "apparatus/parts/cone/series.hpp"
#include "apparatus/parts/cone/set_up.hpp"
#include "apparatus/run/energy_watch.hpp"
#include "libmpm/explicit/archived_state.hpp"
#include "libmpm/explicit/step.hpp"

namespace tremie::cone {

/// Simulated time between two lines of the series [s].
inline constexpr double reading_interval = 0.02;

inline ExplicitSettings explicit_settings(const Scene& scene) {
  const StepSettings common = step_settings(scene);
  ExplicitSettings settings;
  settings.stress = scene.model.scheme == SchemeKind::explicit_usf ? StressUpdate::first : StressUpdate::last;
  settings.transfer = common.transfer;
  settings.cell_pressure = scene.model.pressure == PressureKind::cell;
  settings.fixed_dt = scene.model.time_step;
  settings.single_precision = scene.model.precision == PrecisionKind::single_sums;
  settings.keep_affine = false;
  settings.keep_shear_rates = true;
  settings.wall_law = common.wall_law;
  settings.wall_gap = common.wall_gap;
  settings.wall_speed = scene.lift_speed.value_or(0.0);
  return settings;
}

/// A GIMP point is as large as it was seeded.
template <class Geometry>
Shape<Geometry::dim> shape_of(const Model& model) {
  Shape<Geometry::dim> shape;
  if (model.shape == ShapeKind::gimp) shape.kind = ShapeFunctions::gimp;
  shape.half.fill(0.5 / model.points_per_cell[0]);
  shape.half[Geometry::up] = 0.5 / model.points_per_cell[1];
  return shape;
}

/// Bytes that one more point costs: sorted with its shear rate and its number, and in a reading; neither has
/// affine velocities.
template <int D>
std::int64_t explicit_bytes_per_point(std::size_t lambda_numbers) {
  constexpr std::int64_t affine = D * D * sizeof(double), number = sizeof(std::int32_t);
  const std::int64_t rate = lambda_numbers > 0 ? 0 : sizeof(double);
  return 2 * (bytes_per_point<D>(lambda_numbers) + rate - affine) + number;
}

/// The frame of a reading, which gives it its arrays: there is no room for both in a large body. Its shear
/// rates are those of the last step.
template <class Geometry>
Frame frame_from(Body<Geometry>& body) {
  auto& points = body.points;
  const auto places = [](auto& from) {
    std::vector<std::array<double, 3>> to(from.size());
    std::transform(from.begin(), from.end(), to.begin(), experiment::in_space<Geometry>);
    release(from);
    return to;
  };
  Frame frame;
  frame.time = body.time;
  frame.position = places(points.x);
  frame.velocity = places(points.v);
  frame.volume = std::move(points.V0);
  for (std::size_t p = 0; p < frame.volume.size(); ++p) frame.volume[p] *= std::exp(points.ln_J[p]);
  frame.pressure = std::move(points.ln_J);
  for (double& ln_J : frame.pressure) ln_J = pressure(ln_J, body.mix.K);
  frame.shear_rate = std::move(points.gamma_dot);
  frame.flocculation = std::move(points.lambda);
  points = {};
  return frame;
}

/// Counts of the steps that were longer than the scheme allows.
struct LimitWatch {
  std::int64_t beyond = 0;
  double worst = 0.0;    ///< largest step over its limit
  bool viscous = false;  ///< of the worst
  double limit = 0.0;

  void see(const ExplicitReport& step) {
    if (!step.beyond_limit) return;
    ++beyond;
    const double shortest = std::min(step.limits.viscous, step.limits.acoustic);
    if (step.dt / shortest <= worst) return;
    worst = step.dt / shortest, limit = shortest;
    viscous = step.limits.viscous < step.limits.acoustic;
  }
  void tell(std::int64_t steps, Checks& checks) const {
    if (beyond == 0) return;
    checks.stability_limit_exceeded = true;
    checks.reasons.push_back(
        fmt::format("{} of {} steps were longer than the explicit scheme is stable for: up to {:.2f} times "
                    "the {} limit of {:.3g} s (model.time_step)",
                    beyond, steps, worst, viscous ? "viscous" : "acoustic", limit));
  }
};

/// Steps of a fixed length end up to half a step beside the test's end.
inline void tell_end(const Scene& scene, double time, Checks& checks) {
  if (std::abs(time - scene.duration) <= 5e-3 * scene.duration) return;
  checks.reasons.push_back(
      fmt::format("the run ended at {:.4g} s, test.duration is {:.4g} s: a model.time_step that divides it",
                  time, scene.duration));
}

/// A reading comes after so many steps at the latest: between two of them nobody can interrupt a run, nor see it.
inline constexpr int most_steps_of_a_reading = 1000;

/// Explicit steps up to a time [s], or as many as one reading may take; the report of the last one.
template <class Geometry, class Law, class State>
StepReport explicit_steps_until(double until, Body<Geometry>& body, const Law& law,
                                const ExplicitSettings& settings, State& state,
                                const RigidWall<Geometry::dim>& wall, LimitWatch& limits, Cost& cost) {
  StepReport step;
  int steps = 0;
  do {
    const ExplicitReport one = explicit_step(body, law, settings, state, wall);
    limits.see(one);
    step = {.dt = one.dt, .converged = true, .failed = one.failed, .max_speed = one.max_speed};
    step.shear_rate_mean = one.shear_rate_mean;
    cost.steps += 1;
  } while (!step.failed && ++steps < most_steps_of_a_reading && body.time < until - 0.5 * state.next_dt);
  return step;
}

template <class Geometry, class Law>
Outcome run_explicit_in(const Scene& scene, const Law& law, const scene::Observer& observer) {
  constexpr int D = Geometry::dim;
  Body<Geometry> body = filled_cone<Geometry>(scene);
  const ExplicitSettings settings = explicit_settings(scene);
  RigidWall<D> wall;
  if (scene.lift_speed) lifted_wall(scene, settings.wall_gap + 0.6 * scene.model.cell[0], wall);

  Outcome outcome;
  const auto read_line = [&](const StepReport& step) { return next_line(scene, body, step, outcome); };
  experiment::show_start(body, observer, read_line,
                         outcome);  // there is no room for a frame beside the tiles
  experiment::EnergyWatch energy(experiment::energy_of<Geometry>(body.points, body.mix.K));
  auto state = start_explicit(body, law, settings, shape_of<Geometry>(scene.model));
  write_back(state, body);  // what a run that fails at once is read from
  LimitWatch limits;
  const experiment::Flow flow{
      .time = [&] { return body.time; },
      .unfinished = [&] { return body.time < scene.duration - 0.5 * state.next_dt; },
      .prepare =
          [&] {
            if (cone_is_gone(scene, body.time, outcome.series.back())) wall = {};
          },
      .advance =
          [&](Checks&, Cost& cost) {
            const double until = std::min(body.time + reading_interval, scene.duration);
            const StepReport step =
                explicit_steps_until(until, body, law, settings, state, wall, limits, cost);
            if (step.failed) return step;
            write_back(state, body);
            cost.cells_active =
                std::max(cost.cells_active, count_active_cells<D>(body.grid.axes, body.points.x));
            return step;
          },
      .frame =
          [&] {
            Frame frame = frame_from(body);
            write_back(state, body);
            return frame;
          },
      .last_frame = [&] { return frame_from(body); },
      .free_to_flow = [&] { return clear_of_the_cone(scene, outcome.series.back()); },
      .stands_since = [&] { return rests_since(scene, outcome.series); },
      .gains_energy =
          [&] {
            energy.see(experiment::energy_of<Geometry>(body.points, body.mix.K), bool{wall});
            return energy.ran_away();
          },
      .tell =
          [&](bool stopped, Checks& checks, Cost& cost) {
            limits.tell(cost.steps, checks);
            if (outcome.status == Status::completed && !stopped) tell_end(scene, body.time, checks);
            energy.tell(checks);
          },
      .state =
          [&](Archive& archive) {
            bool walled{wall};
            archive(walled, energy, limits, outcome.series, outcome.results.through_the_cone,
                    outcome.results.height_scale);
            visit_explicit(archive, body, state);
            if (!walled) wall = {};
          }};
  experiment::run_experiment(
      flow, body, showing(scene), observer, read_line,
      [&](std::optional<double> stopped_at) {
        read_results(scene, stopped_at, outcome);
        add_reasons(scene, outcome);
        outcome.cost.bytes_per_point = explicit_bytes_per_point<D>(body.points.lambda_numbers());
      },
      outcome);
  return outcome;
}

}  // namespace tremie::cone
