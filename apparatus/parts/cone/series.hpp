#pragma once

// What is read off the slump flow after every step and at its end.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "apparatus/parts/cone/set_up.hpp"
#include "apparatus/parts/cone/spread.hpp"
#include "apparatus/run/body_readings.hpp"
#include "apparatus/run/experiment.hpp"

namespace tremie::cone {

inline constexpr double standard_t500 = 0.5;  ///< diameter of the t500 circle [m]

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
  s.reach = mean_distance(points);
  s.max_speed = step.max_speed;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = experiment::mean_flocculation(points);
  s.volume_change = experiment::volume_change(points);
  s.kinetic_energy = (is_quarter(scene) ? 4.0 : 1.0) * experiment::kinetic_energy(points);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  return s;
}

inline void read_results(const Scene& scene, std::optional<double> stopped_at, Outcome& outcome) {
  const Sample &first = outcome.series.front(), &last = outcome.series.back();
  Results& r = outcome.results;
  r.spread = last.spread;
  r.spread_max_point = last.spread_max_point;
  r.height = last.height;
  r.flocculation_mean_start = first.flocculation_mean;
  r.flocculation_mean_end = last.flocculation_mean;
  for (const Sample& s : outcome.series)
    r.shear_rate_mean_peak = std::max(r.shear_rate_mean_peak, s.shear_rate_mean);
  r.stopped_at = stopped_at;
  if (stopped_at && *r.stopped_at > 0.0) r.mean_velocity = (r.spread - 0.2) / (2.0 * *r.stopped_at);
  // The standards read it with the Abrams cone, upright or upside down.
  if (is_abrams(scene.cone, true)) r.t500 = time_to_spread(outcome.series, standard_t500);
}

/// Where the heights of the step are read: this far around the axis, and this far beyond the bars [m]. A laboratory reads
/// them at points; two of the default cells are needed.
inline constexpr double at_the_centre = 0.05, beside_the_ring = 0.03;

/// Mean height of the concrete between two distances from the axis [m].
inline double mean_height(const Scene& scene, const Points<3>& points, double inner, double outer) {
  double volume = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (const double r = std::hypot(points.x[p][0], points.x[p][1]); r >= inner && r < outer)
      volume += points.volume(p);
  return (is_quarter(scene) ? 4.0 : 1.0) * volume / (std::numbers::pi * (outer * outer - inner * inner));
}

/// The blocking step of EN 12350-12: height at the centre less that outside of the bars [m].
inline double step_at_the_ring(const Scene& scene, const Points<3>& points) {
  const double bars = 0.5 * (scene.ring->diameter + scene.ring->bar_diameter);
  return mean_height(scene, points, 0.0, at_the_centre) -
         mean_height(scene, points, bars, bars + beside_the_ring);
}

/// The next line of the series; the share of the concrete that went through a low cone's wall is kept.
template <class Geometry>
Sample next_line(const Scene& scene, const Body<Geometry>& body, const StepReport& step, Outcome& outcome) {
  const bool low = scene.lift_speed && !outcome.series.empty() &&
                   rim_height(scene, outcome.series.back().time) < scene.model.cell[1];
  if (low) outcome.results.through_the_cone = share_behind_wall(scene, body.time, body.points);
  Sample line = read(scene, body, step);
  // The full cone is as high as it is.
  if (outcome.series.empty() && line.height > 0.0)
    outcome.results.height_scale = scene.cone.height / line.height;
  line.height *= outcome.results.height_scale;
  return line;
}

/// How a run is shown.
inline experiment::Showing<Sample> showing(const Scene& scene) {
  return {scene.duration, scene.frame_interval,
          [](const Sample& s) { return fmt::format("spread {:.0f} mm", 1e3 * s.spread); }};
}

/// Whether the rim has risen clear of the concrete, so that the cone no longer holds it.
inline bool clear_of_the_cone(const Scene& scene, const Sample& now) {
  return !scene.lift_speed || rim_height(scene, now.time) > now.height + scene.model.cell[1];
}

/// The exponent n of a law's viscous stress k gamma_dot^n; 1 where the viscosity does not depend on the rate.
inline double flow_index(const YieldLaw& law) {
  return std::visit(
      [](const auto& l) {
        if constexpr (requires { l.n; })
          return l.n;
        else
          return 1.0;
      },
      law);
}

/// The last line of the series until a time [s]; none before the first.
inline const Sample* line_at(const std::vector<Sample>& series, double time) {
  const auto line = std::find_if(series.rbegin(), series.rend(),
                                 [time](const Sample& s) { return s.time <= time * (1.0 + 1e-9); });
  return line == series.rend() ? nullptr : &*line;
}

/// How much faster than the mean distance the front has grown since a fifth of the time: both by shares. 1 where neither grew
/// by more than the front's grains.
inline double front_over_mean(const Sample& now, const Sample& early) {
  const double grown = now.reach / early.reach - 1.0;
  return grown > 2e-3 ? std::clamp((now.spread / early.spread - 1.0) / grown, 1.0, 4.0) : 1.0;
}

/// The share of its spread that a flow would still gain, as it went on in the second half of `time` [s]. Near rest the excess of
/// the stress over the yield stress, and with it what is left to flow, goes like t^-n, n the law's flow index: what is left is
/// what was gained since half the time, over 2^n - 1. (A Newtonian fluid, whose reach goes like t^(1/8), never comes near to rest
/// by that.) It is told by the mean distance from the axis, which has no grains.
inline double gain_left(const Scene& scene, const std::vector<Sample>& series, double time) {
  const Sample *now = line_at(series, time), *half = line_at(series, 0.5 * time),
               *early = line_at(series, 0.2 * time);
  if (!early || now == half) return 1.0;
  const double n = flow_index(scene.model.law);
  // Steps are long: the line before half the time is older than half.
  const double shrunk = std::pow(now->time / half->time, n) - 1.0;
  return front_over_mean(*now, *early) * std::abs(now->reach / half->reach - 1.0) / shrunk;
}

/// Whether the reach grows more slowly than it did a half of the time ago. As t^-n comes to its end its rate falls to
/// 2^-(n + 1) of that; what sets out goes on as fast or faster, however little it has moved yet.
inline bool slows_down(const std::vector<Sample>& series, double time) {
  const Sample *now = line_at(series, time), *half = line_at(series, 0.5 * time),
               *quarter = line_at(series, 0.25 * time);
  if (!quarter || now == half || half == quarter) return true;
  const auto rate = [](const Sample& a, const Sample& b) {
    return std::abs(a.reach - b.reach) / (a.time - b.time);
  };
  const double late = rate(*now, *half);
  return late * time < 1e-5 * now->reach || late < 0.75 * rate(*half, *quarter);
}

/// A flow is not looked at before, in free falls from the cone's height, of which 0.25 s is the Abrams cone's.
inline constexpr double first_look = 2.0;

inline double free_fall_time(const Scene& scene) { return std::sqrt(2.0 * scene.cone.height / gravity); }

/// Whether the body still moves though it does not spread, as a rim that overhangs a low mould's foot falls at first, or as one
/// that has hardly set out. By its mean speed it would go on by ten times the tolerance in the time that has passed (at rest it is
/// half of the tolerance), or that speed over its depth takes more than the tolerance's share of its weight (at rest 1e-5).
inline bool still_moves(const Scene& scene, const Sample& now) {
  const double tolerance = scene.rest_tolerance, weight = scene.mix.density * gravity;
  const double speed = std::sqrt(2.0 * now.kinetic_energy / (scene.mix.density * volume(scene.cone)));
  const double depth = std::max(now.height, scene.model.cell[1]), rate = speed / depth;
  const double viscous = (scene.mix.mu + viscosity(scene.model.law, std::max(rate, 1e-12), 0.0)) * rate;
  return speed * now.time > 10.0 * tolerance * 0.5 * now.spread || viscous > tolerance * weight * depth;
}

/// Since when the body has been within `tolerance` of the reach that it ended with, after its first fall [s]. The mean distance
/// tells it, which is smooth in the viscosity: what is left to gain, by which a run ends, scatters as much as the tolerance.
inline double within_since(const Scene& scene, const std::vector<Sample>& series) {
  const auto moves = [&](const Sample& s) { return still_moves(scene, s); };
  const auto fell = std::find_if(series.begin(), series.end(), moves);
  const auto landed = fell == series.end() ? series.begin() : std::find_if_not(fell, series.end(), moves);
  const double end = series.back().reach, band = scene.rest_tolerance * end;
  auto i = std::prev(series.end());
  while (i != landed && std::abs(std::prev(i)->reach - end) <= band) --i;
  if (i == landed) return i->time;
  const auto before = std::prev(i);
  const double share = (std::abs(before->reach - end) - band) / std::abs(i->reach - before->reach);
  return before->time + std::clamp(share, 0.0, 1.0) * (i->time - before->time);
}

/// Since when the concrete, free of the cone, rests: since it was within the scene's tolerance of where it ended [s]; empty
/// while it would gain more.
inline std::optional<double> rests_since(const Scene& scene, const std::vector<Sample>& series) {
  const Sample& now = series.back();
  const double tolerance = scene.rest_tolerance;
  if (now.time < first_look * free_fall_time(scene) || !clear_of_the_cone(scene, now)) return std::nullopt;
  if (gain_left(scene, series, now.time) > tolerance ||
      gain_left(scene, series, 0.8 * now.time) > 2.0 * tolerance)
    return std::nullopt;
  if (!slows_down(series, now.time) || still_moves(scene, now)) return std::nullopt;
  return within_since(scene, series);
}

/// Whether the cone is so far above the concrete that its wall need not be computed.
inline bool cone_is_gone(const Scene& scene, double time, const Sample& last) {
  return scene.lift_speed && rim_height(scene, time) > last.height + 0.02;
}

}  // namespace tremie::cone
