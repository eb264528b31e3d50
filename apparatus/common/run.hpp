#pragma once

// What every apparatus does the same way with libmpm: settings from a scene's model, the rest before a test,
// frames, means and checks. Geometry, schedule and what is read off stay in each apparatus' own folder.

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include "apparatus/common/model.hpp"
#include "libmpm/boundary/flat_walls.hpp"
#include "libmpm/implicit/step.hpp"
#include "libmpm/implicit/step_size.hpp"

namespace tremie::engine {

inline constexpr double gravity = 9.81;        ///< [m/s^2]
inline constexpr double rest_speed = 1e-4;     ///< slower than this is at rest [m/s]
inline constexpr double rest_must_last = 0.5;  ///< before a flow is called stopped [s]

inline FaceKind face_of(ContactKind contact) {
  return contact == ContactKind::no_slip    ? FaceKind::no_slip
         : contact == ContactKind::friction ? FaceKind::friction
                                            : FaceKind::free_slip;
}

inline StepSettings step_settings(const Model& model) {
  StepSettings settings;
  settings.method = model.method == MethodKind::admm     ? YieldMethod::admm
                    : model.method == MethodKind::newton ? YieldMethod::newton
                                                         : YieldMethod::automatic;
  settings.transfer.flip = model.transfer == TransferKind::flip;
  settings.transfer.flip_blend = model.flip_blend;
  settings.particle_shifting.on = model.particle_shifting;
  settings.fixed_dt = model.time_step;
  settings.dt_max *= model.step_scale;
  return settings;
}

/// Throws std::invalid_argument for a scheme or shape that has no engine.
inline void refuse_what_has_no_engine(const Model& model, const char* apparatus) {
  if (model.scheme != SchemeKind::implicit)
    throw std::invalid_argument(std::string("model.scheme: the ") + apparatus +
                                " runs with \"implicit\" for now");
  if (model.shape != ShapeKind::b_spline)
    throw std::invalid_argument(std::string("model.shape: the ") + apparatus +
                                " runs with \"b_spline\" for now");
}

/// lambda of every point after a rest; nothing is stored for a mix without thixotropy.
template <class Geometry>
void rest(Body<Geometry>& body, double duration) {
  if (!body.mix.thixotropy) return;
  const Thixotropy& t = *body.mix.thixotropy;
  body.points.lambda.assign(body.points.size(),
                            flocculation_after_rest(t.initial_flocculation, t, body.mix.tau_0, duration));
  body.points.gamma_dot.assign(body.points.size(), 0.0);
}

template <int D>
double total_volume(const Points<D>& points) {
  double V = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) V += points.volume(p);
  return V;
}

template <int D>
double total_mass(const Points<D>& points) {
  double m = 0.0;
  for (double mass : points.mass) m += mass;
  return m;
}

/// sum V / sum V0 - 1, against the stress-free volume.
template <int D>
double volume_change(const Points<D>& points) {
  double V0 = 0.0;
  for (double v : points.V0) V0 += v;
  return total_volume(points) / V0 - 1.0;
}

template <int D>
double kinetic_energy(const Points<D>& points) {
  double e = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) e += 0.5 * points.mass[p] * points.v[p].squaredNorm();
  return e;
}

/// Volume mean of lambda; empty without thixotropy.
template <int D>
std::optional<double> mean_flocculation(const Points<D>& points) {
  if (!points.thixotropic()) return std::nullopt;
  double sum = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) sum += points.volume(p) * points.lambda[p];
  return sum / total_volume(points);
}

/// Points that are not finite or lie beyond a wall at the end of an axis.
template <int D>
std::int64_t points_lost(const std::array<Axis, D>& axes, const Points<D>& points) {
  std::int64_t lost = 0;
  for (const Vec<D>& x : points.x) {
    bool in = x.allFinite();
    for (int d = 0; d < D; ++d) {
      in = in && !(axes[d].wall_low() && x[d] < axes[d].origin);
      in = in && !(axes[d].wall_high() && x[d] > axes[d].origin + axes[d].length());
    }
    lost += in ? 0 : 1;
  }
  return lost;
}

/// Place of a point for the frames: an axisymmetric section lies in the plane (r, 0, z), a plane one in (x,
/// y, 0), circling concrete on the line (r, 0, 0).
template <class Geometry>
std::array<double, 3> in_space(const Vec<Geometry::dim>& x) {
  if constexpr (Geometry::dim == 3)
    return {x[0], x[1], x[2]};
  else if constexpr (Geometry::dim == 1)
    return {x[0], 0.0, 0.0};
  else if constexpr (std::is_same_v<Geometry, Axisymmetric>)
    return {x[0], 0.0, x[1]};
  else if constexpr (std::is_same_v<Geometry, Polar>)
    return {x[0] * std::cos(x[1]), x[0] * std::sin(x[1]), 0.0};
  else
    return {x[0], x[1], 0.0};
}

/// Shear rates where the points are now [1/s], from their own velocities: the body's grid is that of the last
/// step's start.
template <class Geometry>
std::vector<double> shear_rates_now(const Body<Geometry>& body) {
  constexpr int D = Geometry::dim;
  ActiveGrid<D> grid;
  grid.axes = body.grid.axes;
  grid.blocks = body.grid.blocks;
  activate(grid, body.points.x);
  NodalState<D> nodes;
  point_to_grid(grid, body.points, nodes);
  std::vector<char> fixed;
  std::vector<FrictionNode<D>> friction;
  detail::apply_flat_walls<D>(grid, body.walls, fixed, friction, nodes.v);
  detail::apply_blocks<D>(grid, fixed, nodes.v);
  std::vector<double> gamma_dot;
  shear_rate_at_points<Geometry>(grid, nodes.v, body.points, gamma_dot);
  return gamma_dot;
}

/// The body's points as they are now. The velocity of circling concrete is (0, v_theta, 0).
template <class Geometry>
Frame frame_of(const Body<Geometry>& body) {
  const auto& points = body.points;
  Frame frame;
  frame.time = body.time;
  frame.shear_rate = shear_rates_now(body);  // first: its grid is gone before the rest is there
  frame.position.reserve(points.size()), frame.velocity.reserve(points.size());
  frame.volume.reserve(points.size()), frame.pressure.reserve(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    frame.position.push_back(in_space<Geometry>(points.x[p]));
    frame.velocity.push_back(in_space<Geometry>(points.v[p]));
    if constexpr (Geometry::dim == 1) frame.velocity.back() = {0.0, points.v[p][0], 0.0};
    if constexpr (std::is_same_v<Geometry, Polar>) {
      const double c = std::cos(points.x[p][1]), s = std::sin(points.x[p][1]);
      const Vec<2>& v = points.v[p];
      frame.velocity.back() = {c * v[0] - s * v[1], s * v[0] + c * v[1], 0.0};
    }
    frame.volume.push_back(points.volume(p));
    frame.pressure.push_back(pressure(points.ln_J[p], body.mix.K));
  }
  frame.flocculation = points.lambda;
  return frame;
}

/// Watches for the flow to come to rest: slow, for long enough, and free to flow.
struct RestWatch {
  std::optional<double> slow_since;

  bool at_rest(bool free_to_flow, double max_speed, double time) {
    if (!free_to_flow || max_speed > rest_speed)
      slow_since.reset();
    else if (!slow_since)
      slow_since = time;
    return slow_since && time - *slow_since >= rest_must_last;
  }
};

/// Adds one step to the counts of a run.
template <class Geometry>
void count_step(const Body<Geometry>& body, const StepReport& step, Checks& checks, Cost& cost) {
  checks.unconverged_steps += step.converged ? 0 : 1;
  cost.steps += 1;
  cost.cells_active = std::max<std::int64_t>(cost.cells_active, body.grid.n_cells());
}

/// A step that the scene fixes is not bound to the cells: how many the fastest point crossed in it.
template <class Geometry>
void watch_fixed_step(const Body<Geometry>& body, const Model& model, const StepReport& step, Checks& checks) {
  if (!model.time_step) return;
  for (int d = 0; d < Geometry::dim; ++d) {
    double v = 0.0;
    for (std::size_t p = 0; p < body.points.size(); ++p)
      v = std::max(v, std::abs(body.motion.rate(body.points.x[p], body.points.v[p])[d]));
    checks.cells_in_a_step = std::max(checks.cells_in_a_step, v * step.dt / body.grid.axes[d].h);
  }
}

/// Ends a run whose last step failed: the points are where they were before it.
inline bool gave_up(const StepReport& step, Status& status, Checks& checks, double time) {
  if (!step.failed) return false;
  status = Status::failed;
  checks.reasons.push_back("the velocities ran away at " + std::to_string(time) + " s; the run ends there");
  return true;
}

/// Fills checks and cost at the end of a run, with the reasons why a result is not to be trusted.
template <class Geometry>
void judge(const Body<Geometry>& body, double start_mass, Checks& checks, Cost& cost) {
  checks.volume_change = volume_change(body.points);
  checks.mass_error = total_mass(body.points) / start_mass - 1.0;
  checks.points_lost = points_lost<Geometry::dim>(body.grid.axes, body.points);
  checks.max_speed_end = detail::max_speed(body.points);
  if (checks.unconverged_steps > 0)
    checks.reasons.push_back(std::to_string(checks.unconverged_steps) + " of " + std::to_string(cost.steps) +
                             " steps did not converge to the tolerance");
  if (checks.points_lost > 0)
    checks.reasons.push_back(std::to_string(checks.points_lost) +
                             " points left the domain or are not finite");
  if (checks.cells_in_a_step > 1.0) {
    checks.stability_limit_exceeded = true;
    checks.reasons.push_back("model.time_step is too long: a point crossed " +
                             std::to_string(std::lround(std::ceil(checks.cells_in_a_step))) +
                             " cells in a step; up to one is trusted");
  }
  cost.points = static_cast<std::int64_t>(body.points.size());
  cost.bytes_per_point = bytes_per_point<Geometry::dim>(body.points.thixotropic());
  cost.simulated = body.time;
}

/// Concrete that has slowed down bears less pressure than where it stood: a change of volume beyond three
/// times that at the start [1], and half a per cent, is the method's. What falls and hits may be compressed
/// more.
inline void judge_volume(double at_start, Checks& checks) {
  constexpr double slow = 1e-2;  // [m/s]
  const double most = 3.0 * std::abs(at_start) + 5e-3;
  if (checks.max_speed_end > slow || !(std::abs(checks.volume_change) > most)) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the concrete's volume changed by %+.2g %%; its weight can account for %.2g %%",
                100.0 * checks.volume_change, 100.0 * most);
  checks.reasons.push_back(text);
}

}  // namespace tremie::engine
