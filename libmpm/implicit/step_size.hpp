#pragma once

// How long a step may be, and whether it was too long.

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "libmpm/implicit/state.hpp"

namespace tremie::detail {

inline constexpr double detached_share = 0.005;  ///< share of the points that may be drops in the air

template <int D>
double max_speed(const Points<D>& points) {
  double v2 = 0.0;
  for (const Vec<D>& v : points.v) v2 = std::max(v2, v.squaredNorm());
  return std::sqrt(v2);
}

/// The speed that all but `share` of the points stay below; `speed(p)` of a point.
template <int D, class Speed>
double speed_of_most(const Points<D>& points, double share, Speed speed) {
  std::vector<double> all(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) all[p] = speed(p);
  if (all.empty()) return 0.0;
  const auto rank = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size()));
  std::nth_element(all.begin(), rank, all.end(), std::greater<>());
  return *rank;
}

/// Local error of a step over the points [m]: backward Euler moves them by dt v_new where the trapezoidal
/// rule has dt (v_new + v_old)/2. Root mean square of the difference.
template <int D>
double local_error(const Points<D>& points, const std::vector<Vec<D>>& v_old, double dt) {
  double sum = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) sum += (points.v[p] - v_old[p]).squaredNorm();
  return 0.5 * dt * std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, points.size())));
}

/// The longest step: dt_max, or longer where that keeps the local error, which grows with dt^2, small enough.
template <class Geometry>
double longest_dt(const ImplicitBody<Geometry>& body, const StepSettings& settings) {
  const double allowed = settings.time_error * body.grid.cell_size_min();
  if (body.dt == 0.0 || body.time_error == 0.0) return settings.dt_max;
  return std::clamp(body.dt * std::sqrt(allowed / body.time_error), settings.dt_max,
                    std::max(settings.dt_max, settings.dt_longest));
}

/// Largest step that keeps every point's move, gravity's pull included, within settings.cfl cells.
template <class Geometry>
double choose_dt(const ImplicitBody<Geometry>& body, const StepSettings& settings) {
  if (settings.fixed_dt) return *settings.fixed_dt;
  double dt = longest_dt(body, settings);
  if (body.dt > 0.0) dt = std::min(dt, settings.growth * body.dt);
  for (int d = 0; d < Geometry::dim && Geometry::advects; ++d) {
    const double v = speed_of_most(body.points, settings.detached, [&](std::size_t p) {
      return std::abs(body.motion.rate(body.points.x[p], body.points.v[p])[d]);
    });
    const double reach = settings.cfl * body.grid.axes[d].h;
    if (v > 0.0) dt = std::min(dt, reach / v);
    // From rest the speed at the end of the step counts: g dt^2 <= reach.
    const double g = std::abs(body.gravity[d]);
    if (body.dt == 0.0 && g > 0.0) dt = std::min(dt, 0.25 * std::sqrt(reach / g));
  }
  return std::min(dt, settings.time_left);
}

/// True if the step would move more concrete than the share that may be drops in the air by more than `cells` cells, or
/// any of it to a non-finite position. Nodes with next to no mass do not count: what they do moves no point.
template <class Geometry>
bool runs_away(const ImplicitBody<Geometry>& body, double share, double dt, double cells = 100.0) {
  const double reach = cells * body.grid.cell_size_min();
  double heaviest = 0.0, total = 0.0, gone = 0.0;
  for (double m : body.nodes.mass) heaviest = std::max(heaviest, m), total += m;
  for (std::size_t i = 0; i < body.v.size(); ++i) {
    if (!body.v[i].allFinite()) return true;
    const double m = body.nodes.mass[i];
    if (Geometry::advects && m > 1e-3 * heaviest && body.v[i].norm() * dt > reach) gone += m;
  }
  return gone > share * total;
}

/// Whether a long step carries more than some drops beyond a cell, or anything beyond ten: the speeds that it
/// was chosen for say nothing of what comes loose in it.
template <class Geometry>
bool starts_to_fall(const ImplicitBody<Geometry>& body, const StepSettings& settings, double dt) {
  return runs_away(body, detached_share, dt, 1.0) || runs_away(body, settings.detached, dt, 10.0);
}

}  // namespace tremie::detail
