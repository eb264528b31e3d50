#pragma once

// From the model that a scene chooses to the settings of a step: what every apparatus does the same way.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "apparatus/common/model.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "libmpm/implicit/step.hpp"

namespace tremie::experiment {

using tremie::gravity;

/// Points are counted one by one up to so many; beyond it their number is the volume over that of a point.
inline constexpr double most_counted = 1e6;

/// A number of steps, points or cells as a whole number; what no program could count is 1e15.
inline std::int64_t whole_steps(double steps) { return std::llround(std::clamp(steps, 0.0, 1e15)); }

/// Points and active cells of a body at rest: `filled` makes it, where it is not too large to be counted one by one.
template <class Filled, class Counted>
void count_points(double cells, double in_a_cell, Filled filled, Counted& e) {
  if (cells * in_a_cell > most_counted) {
    e.points = whole_steps(cells * in_a_cell), e.cells_active = whole_steps(cells);
    return;
  }
  auto body = filled();
  activate(body.grid, body.points.x);
  e.points = static_cast<std::int64_t>(body.points.size());
  e.cells_active = body.grid.n_cells();
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

/// A step that the scene fixes, or what is left of its time [s]: the test ends when it says, with no sliver of a step.
inline std::optional<double> fixed_step(const Model& model, double left) {
  if (!model.time_step) return std::nullopt;
  return left < *model.time_step * (1.0 + 1e-6) ? left : *model.time_step;
}

/// The longest step to come where `left` is the test's time [s] and `dt` was the last step: two halves at the end, where
/// one step would leave a sliver. A sliver resolves the sound in stiff concrete, which the steps before it left out.
/// The second half leaves as much as it takes, to rounding, which must not halve it again.
inline double without_sliver(double left, double dt) {
  const bool same = left <= dt * (1.0 + 1e-9);
  return !same && left < 2.0 * dt ? 0.5 * left : left;
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

}  // namespace tremie::experiment
