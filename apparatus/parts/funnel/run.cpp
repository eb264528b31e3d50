// The funnel by implicit steps.

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "apparatus/parts/funnel/funnel.hpp"
#include "apparatus/run/body_readings.hpp"
#include "apparatus/run/experiment.hpp"
#include "apparatus/run/step_settings.hpp"
#include "libmpm/implicit/archived_state.hpp"

namespace tremie::funnel {
namespace {

using experiment::gravity;

/// Of the wall, in m/dt: so stiff that the weight of the concrete presses less than a thousandth of the discharge into it.
constexpr double wall_stiffness = 1e6;

/// Distance of the wall's points, in cells: with two in a cell the wall takes away a quarter of a cell of the mouth, and through
/// gaps of more than one the concrete leaks.
constexpr double wall_spacing = 0.75;

/// Share of the points that may be drops in the air.
constexpr double detached_share = 0.005;

/// Longer steps carry a fluid past its level [s].
constexpr double longest_step = 0.03;

/// Penalty of the yield solver, in viscosities: nearly all of the concrete is sheared, and where it yields a stiff penalty is slow.
/// A tenth of the solver's own takes a third of its iterations in the V-funnel, and in no funnel more.
constexpr double yield_penalty = 0.3;

/// Light is seen where nothing is left over this share of the mouth, at its axis.
constexpr double light_spot = 0.1;

/// The discharge is that over the last tenth of a second [s]: in a step a few points leave, or none.
constexpr double discharge_window = 0.1;

double distance_of_points(const std::array<Axis, 2>& axes) {
  return wall_spacing * std::min(axes[0].h, axes[1].h);
}

template <class Geometry>
Body<Geometry> filled_funnel(const Scene& scene) {
  Body<Geometry> body;
  body.mix = scene.mix;
  body.gravity[1] = -gravity;
  const auto [h, h_up] = scene.model.cell;
  const auto [n, n_up] = scene.model.points_per_cell;
  // A whole number of cells from the axis to the rim of the mouth.
  const double half = 0.5 * scene.shape.mouth, cells = std::max(1.0, std::round(half / h));
  body.grid.axes[0] = {.h = half / cells, .low = FaceKind::free_slip};
  body.grid.axes[1] = {.h = h_up};
  fill(scene.shape, scene.mix, gravity, body.grid.axes[0].h / n, h_up / n_up, body.points);
  body.boundary =
      wall_points(scene.shape, distance_of_points(body.grid.axes), face(scene.walls) != FaceKind::no_slip);
  experiment::rest(body, scene.rest);
  return body;
}

StepSettings step_settings(const Scene& scene) {
  StepSettings settings = experiment::step_settings(scene.model);
  settings.dt_max = longest_step * scene.model.step_scale;
  if (!scene.model.time_step) settings.detached = detached_share;
  settings.boundary_stiffness = wall_stiffness;
  settings.admm.penalty = yield_penalty;
  settings.wall_law = scene.walls;
  if (scene.model.space == SpaceKind::plane_with_side_walls && face(scene.walls) != FaceKind::free_slip)
    settings.side_wall_distance = scene.shape.depth;
  return settings;
}

/// Whether nothing is left above the mouth near its axis.
bool light_seen(const Scene& scene, const Points<2>& points) {
  const double apart = scene.model.cell[0] / scene.model.points_per_cell[0];
  const double spot = std::max(light_spot * 0.5 * scene.shape.mouth, 1.5 * apart);
  return std::none_of(points.x.begin(), points.x.end(),
                      [spot](const Vec<2>& x) { return x[0] < spot && x[1] > 0.0; });
}

double height_at_axis(const Points<2>& points, double reach) {
  double highest = 0.0;
  for (const Vec<2>& x : points.x)
    if (x[0] < reach) highest = std::max(highest, x[1]);
  return highest;
}

double mass_inside(const Points<2>& points) {
  double mass = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.x[p][1] > 0.0) mass += points.mass[p];
  return mass;
}

/// What has left by a line of the series, over the time since one that is older by the window [m^3/s].
double discharge(const std::vector<Sample>& series, const Sample& now, double volume) {
  const auto before = std::find_if(series.rbegin(), series.rend(),
                                   [&](const Sample& s) { return s.time <= now.time - discharge_window; });
  const Sample& then = before == series.rend() ? series.front() : *before;
  return now.time > then.time ? volume * (now.emptied - then.emptied) / (now.time - then.time) : 0.0;
}

/// What goes on from step to step beside the body.
struct Course {
  Outflow left = {};
  double mass_at_start = 0.0, volume_at_start = 0.0;  ///< of the section
  bool light = false;
};

template <class Geometry>
Sample read(const Scene& scene, const Body<Geometry>& body, const StepReport& step, const Course& course,
            const Outcome& outcome) {
  Sample s;
  s.time = body.time;
  s.emptied = 1.0 - mass_inside(body.points) / course.mass_at_start;
  if (!outcome.series.empty()) s.discharge = discharge(outcome.series, s, volume(scene.shape));
  s.height = height_at_axis(body.points, body.grid.axes[0].h);
  s.max_speed = step.max_speed;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = experiment::mean_flocculation(body.points);
  s.volume_change = experiment::volume_change(body.points);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  return s;
}

/// Puts back what a step took through the wall.
template <class Geometry>
void keep_inside(const RigidWall<2>& wall, double before, const std::vector<Vec<2>>& from, double margin,
                 Body<Geometry>& body) {
  const bool through = std::any_of(body.points.x.begin(), body.points.x.end(), [&](const Vec<2>& x) {
    const auto view = wall(x, body.time);
    return view && view->gap < 0.0;
  });
  if (through) keep_on_its_side<2>(wall, before, body.time, from, margin, body.points.x);
}

template <class Geometry>
void read_results(const Scene& scene, const Body<Geometry>& body, const Course& course,
                  std::optional<double> stopped_at, Outcome& outcome) {
  Results& r = outcome.results;
  r.emptied = outcome.series.back().emptied;
  r.stopped_at = stopped_at;
  if (course.light) r.flow_time = outcome.series.back().time, r.stopped_at.reset();
  r.volume = volume(scene.shape);
  const double now = course.left.volume + experiment::total_volume(body.points);
  r.volume_error = now / course.volume_at_start - 1.0;
  outcome.checks.mass_error =
      (course.left.mass + experiment::total_mass(body.points)) / course.mass_at_start - 1.0;
}

template <class Geometry>
Outcome run_in(const Scene& scene, const scene::Observer& observer) {
  ImplicitBody<Geometry> body{filled_funnel<Geometry>(scene)};
  if (wall_stress(scene.walls)) body.strips = wall_strips(scene.shape, distance_of_points(body.grid.axes));
  StepSettings settings = step_settings(scene);
  const double margin = 0.05 * scene.model.cell[0] / scene.model.points_per_cell[0];
  const RigidWall<2> wall = wall_of(scene.shape, scene.shape.top);
  const Outlet<2> outlet{{0.0, -1.0}, drop_below_mouth(scene)};
  Course course{.mass_at_start = experiment::total_mass(body.points),
                .volume_at_start = experiment::total_volume(body.points)};
  Outcome outcome;
  const experiment::Flow flow{
      .time = [&] { return body.time; },
      .unfinished = [&] { return !course.light && experiment::has_time_left(body.time, scene.duration); },
      .prepare =
          [&] {
            const double left = scene.duration - body.time;
            settings.time_left = experiment::without_sliver(left, body.dt);
            settings.fixed_dt = experiment::fixed_step(scene.model, left);
          },
      .advance =
          [&](Checks& checks, Cost& cost) {
            const auto from = body.points.x;
            const double before = body.time;
            const StepReport step = implicit_step(body, scene.model.law, settings);
            if (step.failed) return step;
            experiment::count_step(body, step, checks, cost);
            experiment::watch_fixed_step(body, scene.model, step, checks);
            keep_inside(wall, before, from, margin, body);
            course.light = light_seen(scene, body.points);
            if (!course.light) let_out(outlet, body.points, course.left);
            return step;
          },
      .frame = [&] { return experiment::frame_of(body); },
      .speed = [](const StepReport& step) { return step.bulk_speed; },
      .free_to_flow = [] { return true; },
      .state = [&](Archive& archive) { archive(body, outcome.series, course); }};
  experiment::run_experiment(
      flow, body,
      {scene.duration, scene.frame_interval,
       [](const Sample& now) { return fmt::format("{:.0f} % out", 100.0 * now.emptied); }},
      observer, [&](const StepReport& step) { return read(scene, body, step, course, outcome); },
      [&](std::optional<double> stopped_at) {
        read_results(scene, body, course, stopped_at, outcome);
        add_reasons(scene, outcome);
      },
      outcome);
  return outcome;
}

template <class Geometry>
void count(const Scene& scene, scene::SizeEstimate& e) {
  const auto [h, h_up] = scene.model.cell;
  const auto [n, n_up] = scene.model.points_per_cell;
  double section = 0.0;
  for (const Part& p : parts_of(scene.shape)) section += 0.5 * (p.half_low + p.half_high) * (p.to - p.from);
  experiment::count_points(
      section / (h * h_up), n * n_up, [&] { return filled_funnel<Geometry>(scene); }, e);
  e.bytes_per_point = bytes_per_point<2>(lambda_numbers(scene.mix));
}

/// Speed in the mouth of a fluid of the mix's viscosity that fills the funnel, by lubrication; no more than free fall.
double speed_in_the_mouth(const Scene& scene) {
  const bool round = scene.shape.depth == 0.0;
  const double mouth = 0.5 * scene.shape.mouth, H = height(scene.shape);
  const double mu = scene.mix.mu + viscosity(scene.model.law, typical_rate, scene.mix.tau_0);
  double resistance = 0.0;  // pressure drop over the mean speed in the mouth
  constexpr int slices = 200;
  for (int i = 0; i < slices; ++i) {
    const double half = half_width(scene.shape, (i + 0.5) / slices * H), wider = mouth / half;
    resistance += mu * H / slices * (round ? 8.0 * wider * wider : 3.0 * wider) / (half * half);
  }
  return std::min(scene.mix.density * gravity * H / resistance, std::sqrt(2.0 * gravity * H));
}

}  // namespace

/// A quarter of the mouth: what hangs below it by then falls faster than it flows, and pulls at nothing.
double drop_below_mouth(const Scene& scene) {
  return std::max(2.0 * scene.model.cell[1], 0.125 * scene.shape.mouth);
}

Outcome run(const Scene& scene, const scene::Observer& observer) {
  experiment::refuse_what_has_no_engine(scene.model, "funnel");
  omp_set_num_threads(scene.threads);
  return scene.shape.depth == 0.0 ? run_in<Axisymmetric>(scene, observer)
                                  : run_in<PlaneStrain>(scene, observer);
}

scene::SizeEstimate estimate(const Scene& scene) {
  experiment::refuse_what_has_no_engine(scene.model, "funnel");
  scene::SizeEstimate e;
  if (scene.shape.depth == 0.0)
    count<Axisymmetric>(scene, e);
  else
    count<PlaneStrain>(scene, e);
  const StepSettings settings = step_settings(scene);
  const double speed = speed_in_the_mouth(scene), mouth = 0.5 * scene.shape.mouth;
  const double area = scene.shape.depth == 0.0 ? 3.14159 * mouth * mouth : 2.0 * mouth * scene.shape.depth;
  e.time_expected = std::min(scene.duration, 2.0 * volume(scene.shape) / (area * speed));
  const double dt = std::min(settings.dt_max, settings.cfl * scene.model.cell[1] / (2.0 * speed));
  e.point_step = 0.75e-6;
  e.steps = experiment::whole_steps(scene.duration / scene.model.time_step.value_or(dt));
  e.steps_expected =
      std::min(e.steps, experiment::whole_steps(e.time_expected / scene.model.time_step.value_or(dt)));
  return e;
}

}  // namespace tremie::funnel
