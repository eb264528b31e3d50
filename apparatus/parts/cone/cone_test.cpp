#include "apparatus/parts/cone/cone_test.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "apparatus/parts/cone/explicit_run.hpp"
#include "apparatus/parts/cone/set_up.hpp"
#include "apparatus/run/passing.hpp"

namespace tremie::cone {
namespace {

bool is_explicit(const Model& model) { return model.scheme != SchemeKind::implicit; }

void refuse_what_has_no_engine(const Scene& scene) {
  if (is_explicit(scene.model) && is_exact(scene.model.law))
    throw std::invalid_argument(
        "model.yield: \"exact\" has an unbounded viscosity at rest, for which no explicit step is short "
        "enough; give a regularised one that the mix's law has (\"papanastasiou\"), or model.scheme = "
        "\"implicit\"");
  if (!is_explicit(scene.model) && scene.model.shape == ShapeKind::gimp)
    throw std::invalid_argument(
        "model.shape: \"gimp\" goes with model.scheme = \"explicit\" or \"explicit_usf\"");
}

/// Active cells, by the volume of the cone or the area of its section.
double cells_of(const Scene& scene) {
  const auto [h, h_up] = scene.model.cell;
  if (scene.model.space == SpaceKind::axisymmetric)
    return 0.5 * (scene.cone.bottom_radius + scene.cone.top_radius) * scene.cone.height / (h * h_up);
  return volume(scene.cone) / (h * h * h_up) / (is_quarter(scene) ? 4.0 : 1.0);
}

template <class Geometry>
void count(const Scene& scene, scene::SizeEstimate& e) {
  const auto [n, n_up] = scene.model.points_per_cell;
  const double cells = cells_of(scene), in_a_cell = std::pow(n, Geometry::dim - 1) * n_up;
  experiment::count_points(
      cells, in_a_cell, [&] { return filled_cone<Geometry>(scene); }, e);
  const std::size_t numbers = lambda_numbers(scene.mix);
  e.bytes_per_point = is_explicit(scene.model) ? explicit_bytes_per_point<Geometry::dim>(numbers)
                                               : bytes_per_point<Geometry::dim>(numbers);
}

double static_yield_stress_at_start(const Scene& scene) {
  double lambda = 0.0;
  if (scene.mix.thixotropy) {
    const Thixotropy& t = *scene.mix.thixotropy;
    lambda = flocculation_after_rest(t.initial_flocculation, t, scene.mix.tau_0, scene.rest);
  }
  return static_yield_stress(lambda, scene.mix.tau_0);
}

/// Longest step of an explicit scheme at the start [s].
double first_explicit_step(const Scene& scene) {
  const Model& model = scene.model;
  const ExplicitSettings settings = explicit_settings(scene);
  const auto limits = stability_limits(scene.mix, model.law, static_yield_stress_at_start(scene),
                                       largest_eigenvalues(shape_of<ThreeD>(model).kind),
                                       std::min(model.cell[0], model.cell[1]));
  return settings.safety * limits.together;
}

/// How long structure holds the concrete back after a rest, where it breaks down by time [s]: twice the time in which the
/// yield stress falls to tau_0, by runs of Mixes A to C; 0 where it does not.
double time_to_break_down(const Scene& scene) {
  if (!scene.mix.thixotropy) return 0.0;
  const auto* kinetics = std::get_if<RatePowerKinetics>(&scene.mix.thixotropy->kinetics);
  if (!kinetics || !(kinetics->breakdown > 0.0) || kinetics->rate_exponent > 0.3) return 0.0;
  return 2.0 * std::log(static_yield_stress_at_start(scene) / scene.mix.tau_0) / kinetics->breakdown;
}

/// When the flow is expected to have come to rest and the run to end [s]: by the viscous time mu/tau_y, as Mixes A
/// to C do with and without rest, to a third; longer where no build-up ends the creep.
double expected_time(const Scene& scene) {
  const double broken_down = time_to_break_down(scene);
  const double tau_y = broken_down > 0.0 ? scene.mix.tau_0 : static_yield_stress_at_start(scene);
  const double viscous = (scene.mix.mu + viscosity(scene.model.law, typical_rate, tau_y)) / tau_y;
  const bool space = scene.model.space != SpaceKind::axisymmetric;
  const double time = 1.2 + broken_down + (space ? 19.0 : scene.mix.thixotropy ? 16.5 : 27.0) * viscous;
  return is_explicit(scene.model) || !(time < scene.duration) ? scene.duration : time;
}

/// Steps at the CFL limit of a collapse at about sqrt(g H) for 0.4 s.
double collapse_steps(const Scene& scene, double cfl) {
  const double speed = std::sqrt(gravity * scene.cone.height);
  return 0.2 * speed / (cfl * std::min(scene.model.cell[0], scene.model.cell[1]));
}

/// What of them a run takes: the less the stiffer the mix. Within 10 % of the steps of Mixes A to C with and without
/// rest and at 300 Pa, on cells of 20×20 to 5×2.5 mm.
double share_of_collapse(const Scene& scene) {
  if (scene.model.space != SpaceKind::axisymmetric) return 0.35;
  const double tau_y =
      time_to_break_down(scene) > 0.0 ? scene.mix.tau_0 : static_yield_stress_at_start(scene);
  const double stiffness = tau_y / (scene.mix.density * gravity * scene.cone.height);
  return std::max(0.1, 0.78 - 3.5 * stiffness);
}

/// Steps that are held short while a slow cone is beside the concrete.
double steps_beside_the_cone(const Scene& scene) {
  const auto slow = slow_lift(scene);
  if (!slow) return 0.0;
  const double until = slow->rise / *scene.lift_speed;
  return std::min(until, scene.duration) / (slow->step * scene.model.step_scale);
}

double cpu_of_a_point(const Scene& scene) {
  if (is_explicit(scene.model)) return 0.12e-6;
  // In three dimensions a cell costs the same however many points it has.
  const auto [across, up] = scene.model.points_per_cell;
  if (scene.model.space != SpaceKind::axisymmetric) return 3.0e-5 / (across * across * up);
  return face(scene.floor.contact) == FaceKind::wall_law ? 1.2e-6 : 0.75e-6;
}

}  // namespace

double volume(const Cone& cone) {
  const double a = cone.bottom_radius, b = cone.top_radius;
  return std::numbers::pi * cone.height / 3.0 * (a * a + a * b + b * b);
}

double scale_of(const Cone& cone) { return std::cbrt(volume(cone) / volume(Cone{})); }

bool is_abrams(const Cone& cone, bool either_way) {
  const Cone abrams, turned{cone.bottom_radius, cone.top_radius, cone.height};
  const auto close = [](double a, double b) { return std::abs(a - b) <= 2.001e-3; };
  return (close(cone.top_radius, abrams.top_radius) && close(cone.bottom_radius, abrams.bottom_radius) &&
          close(cone.height, abrams.height)) ||
         (either_way && is_abrams(turned));
}

Outcome run(const Scene& scene, const scene::Observer& observer) {
  refuse_what_has_no_engine(scene);
  omp_set_num_threads(scene.threads);
  return is_explicit(scene.model) ? run_explicit(scene, observer) : run_implicit(scene, observer);
}

scene::SizeEstimate estimate(const Scene& scene) {
  refuse_what_has_no_engine(scene);
  scene::SizeEstimate e;
  if (scene.model.space == SpaceKind::axisymmetric)
    count<Axisymmetric>(scene, e);
  else
    count<ThreeD>(scene, e);
  e.time_expected = expected_time(scene);
  e.point_step = cpu_of_a_point(scene);
  if (is_explicit(scene.model)) {
    const double dt = scene.model.time_step.value_or(first_explicit_step(scene));
    e.steps = experiment::whole_steps(scene.duration / dt);
    e.steps_expected = experiment::whole_steps(e.time_expected / dt);
    return e;
  }
  const StepSettings settings = step_settings(scene);
  // After the collapse the flow goes on in twice the largest step on average, in space 4 times, as the local error lets
  // it grow. Steps that are short beside a slow cone stand for half of those that the collapse would take.
  const double later = (scene.model.space == SpaceKind::axisymmetric ? 2.0 : 4.0) * settings.dt_max;
  const double beside = steps_beside_the_cone(scene);
  const auto steps = [&](double share, double time) {
    if (scene.model.time_step) return experiment::whole_steps(time / *scene.model.time_step);
    const double fast = share * collapse_steps(scene, settings.cfl) * (beside > 0.0 ? 0.5 : 1.0);
    return experiment::whole_steps(beside + fast + time / later);
  };
  e.steps = steps(1.0, scene.duration);
  e.steps_expected = std::min(e.steps, steps(share_of_collapse(scene), e.time_expected));
  return e;
}

std::optional<double> time_to_spread(const std::vector<Sample>& series, double diameter) {
  return experiment::time_of_passing(series, &Sample::spread, diameter);
}

std::string spread_class(double spread) {
  const long mm = 10 * std::lround(100.0 * spread);
  if (mm >= 550 && mm <= 650) return "SF1";
  if (mm >= 660 && mm <= 750) return "SF2";
  if (mm >= 760 && mm <= 850) return "SF3";
  return "";
}

std::string slump_class(double slump) {
  const long mm = 10 * std::lround(100.0 * slump);
  if (mm < 10) return "";
  return mm <= 40 ? "S1" : mm <= 90 ? "S2" : mm <= 150 ? "S3" : mm <= 210 ? "S4" : "S5";
}

}  // namespace tremie::cone
