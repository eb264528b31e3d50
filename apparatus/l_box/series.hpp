#pragma once

// What is read off the series of a run: times of the front, rest, the speed at the bars.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "apparatus/l_box/l_box.hpp"
#include "libmpm/boundary/slender_bars.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::l_box {

/// When the front passed a distance from the gate.
inline std::optional<double> time_of_front(const std::vector<Sample>& series, double distance) {
  for (std::size_t i = 1; i < series.size(); ++i) {
    const Sample &a = series[i - 1], &b = series[i];
    if (b.front < distance) continue;
    return a.time + (distance - a.front) / (b.front - a.front) * (b.time - a.time);
  }
  return std::nullopt;
}

/// A box stands where its depths and its front have moved by less than this for so long: what a person with a rule
/// sees. Films on the walls in space drain for as long as one looks.
inline constexpr double standing_within = 1e-3, standing_lasts = 30.0;  // [m], [s]

/// The last line of the series that is at least standing_lasts old; the end of the series where there is none.
inline std::vector<Sample>::const_iterator line_before(const std::vector<Sample>& series) {
  const auto old = std::find_if(series.rbegin(), series.rend(), [&](const Sample& s) {
    return s.time <= series.back().time - standing_lasts;
  });
  return old == series.rend() ? series.end() : std::prev(old.base());
}

/// Since when the box stands [s]; empty while it does not.
inline std::optional<double> stands_since(const std::vector<Sample>& series) {
  const auto old = line_before(series);
  if (old == series.end()) return std::nullopt;
  const auto moved = [](double a, double b) { return std::abs(a - b) > standing_within; };
  for (auto s = old; s != series.end(); ++s)
    if (moved(s->h1, old->h1) || moved(s->front, old->front) || s->h2.has_value() != old->h2.has_value() ||
        (s->h2 && moved(*s->h2, *old->h2)))
      return std::nullopt;
  return old->time;
}

/// Change of H2/H1 over the last standing_lasts [1/s]; empty where there was none that long ago.
inline std::optional<double> ratio_change(const std::vector<Sample>& series) {
  const auto old = line_before(series);
  const Sample& last = series.back();
  if (old == series.end() || !old->h2 || !last.h2 || old->h1 <= 0.0 || last.h1 <= 0.0) return std::nullopt;
  return (*last.h2 / last.h1 - *old->h2 / old->h1) / (last.time - old->time);
}

/// What H1 exceeds H2 by in a bed of depth h at rest, `length` between the two, where it flowed as far as its yield
/// stress lets it: floor and side walls hold tau_0 (1 + 2 h/W) of rho g h dh/dx, and the bars their own [m].
inline double drop_at_rest(const Scene& scene, double h, double length) {
  const double floor_and_walls = (1.0 / h + (scene.side_walls_slip ? 0.0 : 2.0 / scene.box.width)) * length;
  const double bars = bar_yield_drag * scene.bars * bar_diameter / scene.box.width;
  return scene.mix.tau_0 / (scene.mix.density * gravity) * (floor_and_walls + bars);
}

/// The drag law of a bar has no inertia. In a Newtonian fluid the drag of a cylinder over its speed is 2.5 times
/// as large at a Reynolds number of 10 as at 1 (drag coefficients of 2.8 and 11).
inline constexpr double most_bar_reynolds = 10.0;

/// Reynolds number of the bars at the fastest that the front was, with the apparent viscosity at that rate.
inline double bar_reynolds(const Scene& scene, const std::vector<Sample>& series) {
  double speed = 0.0;
  for (std::size_t i = 1; i < series.size(); ++i)
    if (series[i].time > series[i - 1].time)
      speed =
          std::max(speed, (series[i].front - series[i - 1].front) / (series[i].time - series[i - 1].time));
  if (speed == 0.0) return 0.0;
  const Mix& mix = scene.mix;
  const double rate = speed / bar_diameter;
  return mix.density * speed * bar_diameter /
         (mix.mu + viscosity(scene.model.law, rate, mix.tau_0) + mix.tau_0 / rate);
}

}  // namespace tremie::l_box
