#include "apparatus/run/run_checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "apparatus/run/step_settings.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/implicit/step_size.hpp"

namespace tremie::experiment {
namespace {

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

/// Why what was counted is not to be trusted.
void tell_reasons(std::int64_t steps, const std::vector<double>& lambda, Checks& checks) {
  if (checks.unconverged_steps > 0)
    checks.reasons.push_back(
        fmt::format("{} of {} steps did not converge to the tolerance", checks.unconverged_steps, steps));
  const auto infinite =
      std::count_if(lambda.begin(), lambda.end(), [](double l) { return !std::isfinite(l * l); });
  if (infinite > 0)
    checks.reasons.push_back(
        fmt::format("the flocculation state is infinite in {} points: reduce "
                    "mix.thixotropy.structuration_rate over mix.yield_stress, or test.rest",
                    infinite));
  if (checks.points_lost > 0)
    checks.reasons.push_back(fmt::format("{} points left the domain or are not finite", checks.points_lost));
  if (checks.cells_in_a_step > 1.0) {
    checks.stability_limit_exceeded = true;
    checks.reasons.push_back(
        fmt::format("model.time_step is too long: a point crossed {} cells in a step; up to one is trusted",
                    std::lround(std::ceil(checks.cells_in_a_step))));
  }
}

}  // namespace

template <class Geometry>
void watch_fixed_step(const Body<Geometry>& body, const Model& model, const StepReport& step,
                      Checks& checks) {
  if (!model.time_step) return;
  for (int d = 0; d < Geometry::dim; ++d) {
    double v = 0.0;
    for (std::size_t p = 0; p < body.points.size(); ++p)
      v = std::max(v, std::abs(body.motion.rate(body.points.x[p], body.points.v[p])[d]));
    checks.cells_in_a_step = std::max(checks.cells_in_a_step, v * step.dt / body.grid.axes[d].h);
  }
}

template <class Geometry>
void judge(const Body<Geometry>& body, double start_mass, Checks& checks, Cost& cost) {
  checks.volume_change = volume_change(body.points);
  checks.mass_error = total_mass(body.points) / start_mass - 1.0;
  checks.points_lost = points_lost<Geometry::dim>(body.grid.axes, body.points);
  checks.max_speed_end = detail::max_speed(body.points);
  tell_reasons(cost.steps, body.points.lambda, checks);
  cost.points = static_cast<std::int64_t>(body.points.size());
  cost.bytes_per_point = bytes_per_point<Geometry::dim>(body.points.lambda_numbers());
  cost.simulated = body.time;
}

void judge_volume(double at_start, Checks& checks) {
  constexpr double slow = 1e-2;  // [m/s]
  const double most = 3.0 * std::abs(at_start) + 5e-3;
  if (checks.max_speed_end > slow || !(std::abs(checks.volume_change) > most)) return;
  checks.reasons.push_back(
      fmt::format("the concrete's volume changed by {:+.2g} %; its weight explains at most {:.2g} %",
                  100.0 * checks.volume_change, 100.0 * most));
}

void judge_squeeze(const Squeeze& squeeze, const Mix& mix, double height, Checks& checks) {
  constexpr double most = 0.15;
  if (!(std::abs(squeeze.most) > most)) return;
  checks.reasons.push_back(fmt::format(
      "the concrete is too soft: its volume changed by {:+.3g} % at {:.3g} s, more than {:g} %, under its "
      "weight{}: use a larger mix.bulk_modulus ({} kPa now; {} kPa keeps it to 1 %)",
      100.0 * squeeze.most, squeeze.at, 100.0 * most, squeeze.collapsed() ? "; the run ends there" : "",
      scene::rounded(1e-3 * mix.K, 3), scene::rounded(0.1 * mix.density * gravity * height, 1)));
}

#define TREMIE_CHECKS_IN(Geometry)                                                                 \
  template void watch_fixed_step(const Body<Geometry>&, const Model&, const StepReport&, Checks&); \
  template void judge(const Body<Geometry>&, double, Checks&, Cost&);
TREMIE_CHECKS_IN(Axisymmetric)
TREMIE_CHECKS_IN(PlaneStrain)
#ifndef TREMIE_SECTIONS_ONLY  // the page for the browser has no vane and nothing in space
TREMIE_CHECKS_IN(Couette)
TREMIE_CHECKS_IN(Polar)
TREMIE_CHECKS_IN(ThreeD)
#endif

std::string one_point_a_cell(const Model& model) {
  constexpr int least = 2;
  if (model.points_per_cell[0] >= least) return {};
  return fmt::format(
      "one point a cell across leaves gaps as soon as the concrete is stretched: use {} or more "
      "model.points_per_cell",
      least);
}

std::string inertia_on_a_cell(const Mix& mix, const YieldLaw& law, double speed, double h) {
  constexpr double most = 10.0;
  const double viscous = mix.mu + viscosity(law, std::max(speed, 1e-9) / h, 0.0);
  const double reynolds = mix.density * speed * h / viscous;
  if (!(reynolds > most)) return {};
  return fmt::format(
      "inertia rules the flow: at {:.2g} m/s the Reynolds number of a cell is {:.0f}, more than {:g}, so "
      "that numerical damping decides how far it goes: use a smaller model.cell upwards",
      speed, reynolds, most);
}

}  // namespace tremie::experiment
