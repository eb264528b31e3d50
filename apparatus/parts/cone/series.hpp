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

inline constexpr double beside_the_ring = 0.05;  ///< as far beyond the bars heights are read [m]

/// Mean height of the concrete between two distances from the axis [m].
inline double mean_height(const Scene& scene, const Points<3>& points, double inner, double outer) {
  double volume = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (const double r = std::hypot(points.x[p][0], points.x[p][1]); r >= inner && r < outer)
      volume += points.volume(p);
  return (is_quarter(scene) ? 4.0 : 1.0) * volume / (std::numbers::pi * (outer * outer - inner * inner));
}

/// Mean height inside the ring less that over the 50 mm outside of it [m].
inline double step_at_the_ring(const Scene& scene, const Points<3>& points) {
  const double middle = 0.5 * scene.ring->diameter, half = 0.5 * scene.ring->bar_diameter;
  return mean_height(scene, points, 0.0, middle - half) -
         mean_height(scene, points, middle + half, middle + half + beside_the_ring);
}

/// The next line of the series; the share of the concrete that went through a low cone's wall is kept.
template <class Geometry>
Sample next_line(const Scene& scene, const Body<Geometry>& body, const StepReport& step, Outcome& outcome) {
  const bool low = scene.lift_speed && !outcome.series.empty() &&
                   rim_height(scene, outcome.series.back().time) < scene.model.cell[1];
  if (low) outcome.results.through_the_cone = share_behind_wall(scene, body.time, body.points);
  return read(scene, body, step);
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

/// Concrete of the Abrams cone stands where spread and height have kept within this for so long. Beside a yield stress of some kPa a step's
/// solution leaves 0.1 mm/s here and there, so that the speed alone would never be that of rest.
inline constexpr double standing_within = 1e-4, standing_lasts = 10.0;  // [m], [s]

/// Since when the concrete, free of the cone, stands [s]; empty while it does not.
inline std::optional<double> stands_since(const Scene& scene, const std::vector<Sample>& series) {
  const Sample& now = series.back();
  for (auto s = series.rbegin(); s != series.rend(); ++s) {
    const double within = standing_within * scale_of(scene.cone);
    if (std::abs(s->spread - now.spread) > within || std::abs(s->height - now.height) > within ||
        !clear_of_the_cone(scene, *s))
      return std::nullopt;
    if (s->time <= now.time - standing_lasts) return s->time;
  }
  return std::nullopt;
}

/// Whether the cone is so far above the concrete that its wall need not be computed.
inline bool cone_is_gone(const Scene& scene, double time, const Sample& last) {
  return scene.lift_speed && rim_height(scene, time) > last.height + 0.02;
}

}  // namespace tremie::cone
