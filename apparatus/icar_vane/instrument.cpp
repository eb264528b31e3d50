#include "apparatus/icar_vane/instrument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "rheometer/fits/apparent_alpha.hpp"
#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/reference/references.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double alpha_window = 5.0;               // at most, where the record is as long [s]
constexpr double end_average = 0.5;                // over which the torques at the end are averaged [s]
constexpr double end_share = 0.2;                  // of a test that is shorter than two seconds and a half
constexpr double agreement = 0.01;                 // of the three torques, once steady
constexpr double agreement_with_reference = 0.02;  // of the torque at the end, Couette sections
constexpr double agreement_regularised = 0.05;     // the same where the law is a regularised one
constexpr double agreement_of_blades = 0.25;       // of blades' torque with a cylinder's, the law regularised
constexpr double cells_of_width =
    1.0;  // of the sheared width at the start, for a fall that the cells do not set
constexpr double cells_of_layer = 2.0;  // of mix.thixotropy.layer, the same
constexpr double settled = 1.0;  // from then on inertia is balanced, and readings are the concrete's [s]

Instrument instrument_of(const Vane& vane) {
  Instrument instrument;
  instrument.vane_radius = vane.radius;
  instrument.vane_height = vane.height;
  instrument.container_radius = vane.container_radius;
  return instrument;
}

/// Mean torque over the last part of every hold of a flow curve.
std::vector<CurvePoint> flow_curve(const Scene& scene, const std::vector<Sample>& series) {
  std::vector<CurvePoint> curve;
  for (std::size_t k = 0; k < scene.speeds.size(); ++k) {
    const double end = scene.pre_shear_time + static_cast<double>(k + 1) * scene.hold_time;
    double sum = 0.0, time = 0.0;
    for (const Sample& s : series) {
      if (s.time > end * (1.0 + 1e-12) || s.time <= end - scene.average_time) continue;
      sum += s.torque * s.time_step;
      time += s.time_step;
    }
    if (time > 0.0) curve.push_back({scene.speeds[k], sum / time});
  }
  return curve;
}

std::optional<ReinerRiwlin> reported_bingham(const std::vector<CurvePoint>& curve,
                                             const Instrument& instrument) {
  std::vector<FlowPoint> points;
  for (const CurvePoint& p : curve) points.push_back({angular_speed(std::abs(p.speed)), std::abs(p.torque)});
  if (points.size() < 2) return std::nullopt;
  const Bingham b = bingham_from_flow_curve(points, instrument);
  return ReinerRiwlin{b.tau_0, b.mu};
}

/// Whether the viscous part is the mix's plastic viscosity, as Reiner-Riwlin's equations have it.
bool is_bingham(const Scene& scene) {
  return !is_viscous(scene.model.law) || newtonian(scene.model.law) > 0.0;
}

/// The wall that slides, as the rheometer's reference has it.
SlidingWall sliding_wall(const Scene& scene) {
  const std::optional<WallStress> stress = wall_stress(scene.walls);
  if (!stress) return {};
  return {scene.cylinder_slides ? scene.vane.radius : scene.vane.container_radius, stress->yield,
          stress->viscous};
}

/// Torque at the end between solid cylinders, by the rheometer's references; empty where it takes SUNDIALS
/// and the build has none, and for concrete with structure along a wall that slides.
std::optional<double> couette_reference(const Scene& scene, const Instrument& instrument) {
  const double omega = angular_speed(std::abs(scene.speed));
  Bingham bingham{scene.mix.tau_0, scene.mix.mu};
  if ((!is_bingham(scene) || slides(scene)) && scene.mix.thixotropy) return std::nullopt;
  if (!is_bingham(scene) || slides(scene))
    return couette_torque(scene.model.law, scene.mix.tau_0, scene.mix.mu, omega, instrument,
                          sliding_wall(scene));
  if (!scene.mix.thixotropy) return reiner_riwlin(bingham, omega, instrument).torque;
  CouetteFlow flow;
  flow.bingham = bingham;
  flow.thixotropy = *scene.mix.thixotropy;
  double& lambda = flow.thixotropy.initial_flocculation;
  lambda = flocculation_after_rest(lambda, flow.thixotropy, scene.mix.tau_0, scene.rest);
  if (!breaks_down(flow.thixotropy.kinetics)) {  // nothing breaks it down: the same everywhere
    if (!gate(flow.thixotropy.kinetics))
      lambda = flocculation_after_rest(lambda, flow.thixotropy, scene.mix.tau_0, scene.duration);
    bingham.tau_0 = static_yield_stress(lambda, bingham.tau_0);
    return reiner_riwlin(bingham, omega, instrument).torque;
  }
  if (!has_integrated_references()) return std::nullopt;
  flow.omega_of_time = [omega](double time) { return omega * start_up(time); };
  const double times[] = {0.0, scene.duration};
  CouetteOptions options;
  if (const double layer = flow.thixotropy.layer; layer > 0.0)  // eight intervals to it at the vane
    options.intervals =
        std::clamp(static_cast<int>(8.0 * std::log(instrument.container_radius / instrument.vane_radius) *
                                    instrument.vane_radius / layer),
                   options.intervals, 4000);
  return thixotropic_couette(flow, times, instrument, options).torque.back();
}

/// Time over which the torques at the end are averaged [s], clear of the start.
double averaged_time(const std::vector<Sample>& series) {
  return std::min(end_average, end_share * series.back().time);
}

/// Mean rate of the angular momentum over so much time before the end [N m].
double momentum_rate_over(const std::vector<Sample>& series, double window) {
  double sum = 0.0, time = 0.0;
  for (std::size_t i = series.size(); i-- > 0 && time < window;) {
    sum += series[i].momentum_rate * series[i].time_step;
    time += series[i].time_step;
  }
  return time > 0.0 ? sum / time : 0.0;
}

void average_end(const std::vector<Sample>& series, Results& r) {
  double time = 0.0;
  r.torque_end = r.torque_wall_end = r.torque_power_end = r.slip_end = 0.0;
  for (std::size_t i = series.size(); i-- > 0 && time < averaged_time(series);) {
    const Sample& s = series[i];
    r.torque_end += s.torque * s.time_step;
    r.torque_wall_end += s.torque_wall * s.time_step;
    r.torque_power_end += s.torque_power * s.time_step;
    r.slip_end += s.slip * s.time_step;
    time += s.time_step;
  }
  if (time == 0.0) return;  // of a run whose first step failed
  for (double* mean : {&r.torque_end, &r.torque_wall_end, &r.torque_power_end, &r.slip_end}) *mean /= time;
}

/// lambda at the peak and the exponent of its decay from there on.
void read_decay(Outcome& outcome) {
  Results& r = outcome.results;
  std::vector<double> time, lambda;
  for (const Sample& s : outcome.series)
    if (s.flocculation_apparent && (!time.empty() || s.torque == r.torque_peak)) {
      time.push_back(s.time);
      lambda.push_back(*s.flocculation_apparent);
    }
  if (lambda.empty()) return;
  r.flocculation_apparent_start = lambda.front();
  const double start = time.front();
  for (double& t : time) t -= start;
  r.alpha_window = std::min(alpha_window, time.back());
  const auto coefficient = exponential_coefficient(time, lambda, r.alpha_window);
  if (coefficient) r.alpha_apparent = *coefficient / r.shear_rate_nominal;
}

/// Fills the results from the series.
void read_instrument(const Scene& scene, Outcome& outcome) {
  Results& r = outcome.results;
  const Instrument instrument = instrument_of(scene.vane);
  for (const Sample& s : outcome.series)
    if (std::abs(s.torque) > std::abs(r.torque_peak)) {
      r.torque_peak = s.torque;
      r.inertia_at_peak = s.momentum_rate;
    }
  average_end(outcome.series, r);
  r.shear_rate_nominal = newtonian_shear_rate(angular_speed(std::abs(scene.speed)), instrument);
  r.flow_curve = flow_curve(scene, outcome.series);
  r.reiner_riwlin = reported_bingham(r.flow_curve, instrument);
  if (!scene.speeds.empty()) {
    if (r.reiner_riwlin) r.dynamic_yield_stress_apparent = r.reiner_riwlin->yield_stress;
    return;
  }
  r.static_yield_stress_apparent = shear_stress_at(scene.vane.radius, std::abs(r.torque_peak), instrument);
  r.dynamic_yield_stress_apparent = shear_stress_at(scene.vane.radius, std::abs(r.torque_end), instrument);
  if (scene.speed == 0.0) return;
  if (scene.with_reference) try {
      const auto torque = couette_reference(scene, instrument);
      if (torque) r.torque_couette_reference = std::copysign(*torque, scene.speed);
    } catch (const std::runtime_error& error) {  // the integrator gave up: no reason to lose the run
      outcome.checks.reasons.push_back(
          fmt::format("the torque cannot be checked against that of a solid cylinder: {}", error.what()));
    }
  read_decay(outcome);
}

/// Torques on the blades, on the wall (with the rate of angular momentum) and from the power must agree at
/// the end; a reason where they do not.
void check_torques_agree(const Scene& scene, Outcome& outcome) {
  const Results& r = outcome.results;
  const double momentum_rate = momentum_rate_over(outcome.series, averaged_time(outcome.series));
  const bool starting = outcome.series.back().time < settled;
  if (starting && !scene.speeds.empty()) return;  // a curve is read where each speed is steady
  // Two balances hold at all times, of angular momentum and, but for the kinetic energy, of power. A torque
  // read while the vane starts is that of the concrete's inertia as well.
  const double scale = std::abs(r.torque_end);
  const double balance = std::abs(r.torque_end - r.torque_wall_end - momentum_rate);
  const double power = std::abs(r.torque_end - r.torque_power_end);
  const double inertia = starting ? std::abs(momentum_rate_over(outcome.series, end_average)) : 0.0;
  const double off = std::max({balance, power, inertia});
  if (scale > 0.0 && off > agreement * scale)
    outcome.checks.reasons.push_back(
        fmt::format("the torques on the blades, on the wall and from the power differ by {:.1f} %: {}",
                    100.0 * off / scale,
                    starting ? "the concrete is still being accelerated: use a longer test.duration"
                             : "the flow is not steady, or the cells are too large"));
}

/// Adds a reason where the steps of a flow curve are as long as what its torques are averaged over: a torque is then read
/// while the concrete is still being accelerated.
void check_curve_steps(const Scene& scene, Outcome& outcome) {
  constexpr double most = 0.25;
  if (scene.speeds.empty() || !scene.model.time_step) return;
  const double share = *scene.model.time_step / scene.average_time;
  if (share <= most * (1.0 + 1e-9)) return;
  outcome.checks.reasons.push_back(
      fmt::format("model.time_step is {:.2g} of test.average_time, more than {:g}: the torques are not those "
                  "of a steady flow; use a shorter model.time_step",
                  share, most));
}

/// Adds a reason where the test ends before the vane has reached its speed.
void check_start_up(const Scene& scene, Outcome& outcome) {
  const double time = outcome.series.back().time;
  if (outcome.status != Status::completed || scene.speed == 0.0 || time > 0.99 * start_up_time) return;
  outcome.checks.reasons.push_back(
      fmt::format("the test ends after {:.3g} s, before the vane has reached its speed, {:g} s: use a longer "
                  "test.duration",
                  time, start_up_time));
}

/// Adds a reason where breakdown that hardly depends on the rate narrows the sheared width to a cell.
void check_localisation(const Scene& scene, Outcome& outcome) {
  const auto width = sheared_width(scene);
  const double cell = scene.model.cell[0], layer = scene.mix.thixotropy ? scene.mix.thixotropy->layer : 0.0;
  if (!width || outcome.series.back().time < settled) return;
  if (layer > 0.0 && layer < cells_of_layer * cell)
    outcome.checks.reasons.push_back(fmt::format(
        "mix.thixotropy.layer is {:.3g} cells: below {:g} cells the torque decay depends on the grid; "
        "use model.cell = \"{:.3g} mm\" or less",
        layer / cell, cells_of_layer, 1e3 * layer / cells_of_layer));
  if (layer == 0.0 && *width < cells_of_width * cell)
    outcome.checks.reasons.push_back(
        fmt::format("the sheared layer at the vane is {:.2g} mm thick, {:.2g} cells: below {:g} cells the "
                    "torque decay depends on the grid; give a length of the material, "
                    "mix.thixotropy.layer, or model.cell = \"{:.2g} mm\" or less",
                    1e3 * *width, *width / cell, cells_of_width, 1e3 * *width / cells_of_width));
}

/// Whether the torque of a start is too small. Inertia only adds to it, and so does structure; but what is sheared in a narrower
/// layer breaks down faster, by which the torque of a thixotropic concrete may fall below that of the equations without inertia.
bool too_small(const Scene& scene, double torque, double reference) {
  constexpr double most_by_breakdown = 0.3;
  const double low = 1.0 - std::abs(torque / reference);
  if (!scene.mix.thixotropy) return low > agreement_with_reference;
  const double without_structure =
      couette_torque(scene.model.law, scene.mix.tau_0, scene.mix.mu, angular_speed(std::abs(scene.speed)),
                     instrument_of(scene.vane));
  return low > most_by_breakdown || 1.0 - std::abs(torque / without_structure) > agreement_with_reference;
}

/// Adds a reason where a Couette section's torque at the end is not that of the radial equations, which its
/// own three readings cannot tell when all of them follow one wrong stress.
void check_against_reference(const Scene& scene, Outcome& outcome) {
  const auto& reference = outcome.results.torque_couette_reference;
  const Sample& last = outcome.series.back();
  const bool cylinder = scene.model.space == SpaceKind::couette;
  if (!reference) return;
  const double torque = last.torque / outcome.results.end_factor.value_or(1.0),
               off = torque / *reference - 1.0;
  if (last.time < start_up_time) return;
  if (last.time < settled && !too_small(scene, torque, *reference)) return;
  if (!is_exact(scene.model.law) && std::abs(off) > (cylinder ? agreement_regularised : agreement_of_blades))
    outcome.checks.reasons.push_back(
        fmt::format("the torque is {:.0f} % off that of the yield stress itself: at this speed the "
                    "regularised law does not reach it; use model.yield = \"exact\"{}",
                    100.0 * off, cylinder ? "" : ", or smaller cells"));
  if (is_exact(scene.model.law) && cylinder && std::abs(off) > agreement_with_reference)
    outcome.checks.reasons.push_back(fmt::format(
        "the torque is {:.1f} % off that of the equations without inertia: the flow is not steady, or "
        "the cells do not resolve its sheared layer",
        100.0 * off));
}

/// As check_against_reference, at each speed of a flow curve: what yields may be thinner than a cell.
void check_curve_against_reference(const Scene& scene, Outcome& outcome) {
  if (scene.model.space != SpaceKind::couette || scene.mix.thixotropy || !is_exact(scene.model.law) ||
      !scene.with_reference)
    return;
  Scene at = scene;
  double most = 0.0;
  for (const CurvePoint& point : outcome.results.flow_curve) {
    at.speed = point.speed;
    if (point.speed == 0.0) continue;
    if (const auto torque = couette_reference(at, instrument_of(scene.vane)))
      if (const double off = std::abs(point.torque) / *torque - 1.0; std::abs(off) > std::abs(most))
        most = off;
  }
  if (std::abs(most) > agreement_with_reference)
    outcome.checks.reasons.push_back(fmt::format(
        "a torque of the flow curve is {:.1f} % off that of the law's steady Couette flow: the flow is not "
        "steady, or the "
        "cells do not resolve its sheared layer; use a longer test.hold_time or a smaller model.cell",
        100.0 * most));
}

}  // namespace

std::optional<double> apparent_flocculation(const Scene& scene, double torque, double speed) {
  if (!scene.mix.thixotropy || speed == 0.0) return std::nullopt;
  const Instrument instrument = instrument_of(scene.vane);
  const double omega = angular_speed(std::abs(speed));
  const double offset =
      is_bingham(scene) ? reiner_riwlin({scene.mix.tau_0, scene.mix.mu}, omega, instrument).torque
                        : couette_torque(scene.model.law, scene.mix.tau_0, scene.mix.mu, omega, instrument);
  return apparent_lambda(std::abs(torque), offset, scene.mix.tau_0, instrument);
}

std::optional<double> sheared_width(const Scene& scene) {
  const auto& t = scene.mix.thixotropy;
  if (!t || !breaks_down(t->kinetics) || !slow_shear_breaks_down(t->kinetics) || !is_exact(scene.model.law))
    return std::nullopt;
  double slowest = std::abs(scene.speeds.empty() ? scene.speed : scene.speeds.front());
  for (const double speed : scene.speeds) slowest = std::min(slowest, std::abs(speed));
  if (slowest == 0.0 || !(scene.rest > 0.0 || t->initial_flocculation > 0.0)) return std::nullopt;
  const double lambda = flocculation_after_rest(t->initial_flocculation, *t, scene.mix.tau_0, scene.rest);
  const auto* power = std::get_if<HerschelBulkley>(&scene.model.law);
  const HerschelBulkleyFluid fluid{static_yield_stress(lambda, scene.mix.tau_0),
                                   power && power->n != 1.0 ? power->k : scene.mix.mu,
                                   power ? power->n : 1.0};
  return steady_torque(fluid, angular_speed(slowest), instrument_of(scene.vane)).sheared_radius -
         scene.vane.radius;
}

std::vector<std::string> localisation_use(const Scene& scene) {
  const auto width = sheared_width(scene);
  if (!width) return {};
  const double layer = scene.mix.thixotropy->layer, cell = scene.model.cell[0];
  std::vector<std::string> lines{
      fmt::format("sheared width of the rested concrete at the vane: {:.3g} mm at the start, {:.2g} cells",
                  1e3 * *width, *width / cell)};
  lines.push_back(layer > 0.0 ? fmt::format("breakdown: by the mean shear rate over {:g} mm, {:.2g} cells",
                                            1e3 * layer, layer / cell)
                              : "breakdown: by the shear rate at the point; below one cell of sheared width "
                                "the torque decay depends on the grid (mix.thixotropy.layer)");
  return lines;
}

std::string progress_text(const Sample& s) { return fmt::format("torque {:.3f} N.m", s.torque); }

void read_and_check(const Scene& scene, Outcome& outcome) {
  read_instrument(scene, outcome);
  check_torques_agree(scene, outcome);
  check_against_reference(scene, outcome);
  check_curve_against_reference(scene, outcome);
  check_localisation(scene, outcome);
  check_curve_steps(scene, outcome);
  check_start_up(scene, outcome);
}

}  // namespace tremie::icar_vane
