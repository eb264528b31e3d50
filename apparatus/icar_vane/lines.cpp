#include "apparatus/icar_vane/lines.hpp"

#include <fmt/format.h>

#include <cmath>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/reference/references.hpp"

namespace tremie::scene {
namespace {

constexpr double torques_must_agree = 0.01;  ///< relative to the torque on the blades

/// One row of the comparison: "yield stress, dynamic    54 Pa    57.2 Pa   +5.9 %".
std::string row(const char* what, double input, std::optional<double> read, const char* unit) {
  const std::string value = std::isfinite(input) ? fmt::format("{:.4g} {}", input, unit) : "-";
  const std::string left = fmt::format("{:<26}{:>12}", what, value);
  if (!read || !std::isfinite(*read)) return left + fmt::format("{:>16}", "-");
  const std::string right = fmt::format("{}{:>16}", left, fmt::format("{:.4g} {}", *read, unit));
  return input == 0.0 || !std::isfinite(input)
             ? right
             : right + fmt::format("   {:+.1f} %", 100.0 * (*read / input - 1.0));
}

void add_comparison(const icar_vane::Scene& scene, const icar_vane::Results& r,
                    std::vector<std::string>& lines) {
  const VaneInput in = vane_input(scene);
  lines.push_back(fmt::format("{:<26}{:>12}{:>16}", "", "input", "instrument"));
  if (r.reiner_riwlin) {
    lines.push_back(row("yield stress", in.yield_stress, r.reiner_riwlin->yield_stress, "Pa"));
    lines.push_back(
        row("plastic viscosity", in.plastic_viscosity, r.reiner_riwlin->plastic_viscosity, "Pa.s"));
  }
  if (r.static_yield_stress_apparent)
    lines.push_back(
        row("apparent at the peak", in.static_yield_stress, r.static_yield_stress_apparent, "Pa"));
  if (r.dynamic_yield_stress_apparent)
    lines.push_back(row("apparent at the end", in.yield_stress, r.dynamic_yield_stress_apparent, "Pa"));
  if (r.dynamic_yield_stress_apparent && scene.mix.thixotropy && scene.rest > 0.0 && scene.speeds.empty())
    lines.push_back(
        "                apparent: T/(2 pi r^2 h), with the viscous part and what flocculation is left in "
        "it; beside it\n"
        "                the static and the dynamic yield stress that went in. Not an error of the "
        "computation");
  if (in.flocculation)
    lines.push_back(row("flocculation at the start", *in.flocculation, r.flocculation_apparent_start, ""));
  if (in.alpha) lines.push_back(row("alpha", *in.alpha, r.alpha_apparent, ""));
}

/// Torque on the blades, on the container and from the power, which must agree but for the rate of angular
/// momentum.
void add_agreement(const icar_vane::Outcome& outcome, std::vector<std::string>& lines) {
  const icar_vane::Results& r = outcome.results;
  const double momentum = outcome.series.empty() ? 0.0 : outcome.series.back().momentum_rate;
  const double scale = std::abs(r.torque_end) > 0.0 ? std::abs(r.torque_end) : 1.0;
  const double wall = (r.torque_wall_end + momentum) / scale - r.torque_end / scale;
  const double power = (r.torque_power_end - r.torque_end) / scale;
  lines.push_back(fmt::format(
      "on the wall     {:.4g} N.m ({:+.2f} % with the rate of angular momentum)   power/speed {:.4g} "
      "N.m ({:+.2f} %)",
      r.torque_wall_end, 100.0 * wall, r.torque_power_end, 100.0 * power));
  if (std::max(std::abs(wall), std::abs(power)) > torques_must_agree)
    lines.push_back(
        "                the three torques differ by more than 1 %: not steady, or cells too large");
}

}  // namespace

VaneInput vane_input(const icar_vane::Scene& scene) {
  VaneInput in;
  in.yield_stress = in.static_yield_stress = scene.mix.tau_0;
  const bool bingham = !is_viscous(scene.model.law) || newtonian(scene.model.law) > 0.0;
  in.plastic_viscosity = bingham ? scene.mix.mu : std::nan("");
  if (!scene.mix.thixotropy) return in;
  const Thixotropy& t = *scene.mix.thixotropy;
  in.flocculation = flocculation_after_rest(t.initial_flocculation, t, scene.mix.tau_0, scene.rest);
  in.static_yield_stress = (1.0 + *in.flocculation) * scene.mix.tau_0;
  in.alpha = destructuration(t.kinetics);
  return in;
}

std::vector<std::string> vane_lines(const icar_vane::Scene& scene, const icar_vane::Outcome& outcome) {
  const icar_vane::Results& r = outcome.results;
  std::vector<std::string> lines{fmt::format("torque          {:.4g} N.m at its peak, {:.4g} N.m at the end",
                                             r.torque_peak, r.torque_end)};
  add_agreement(outcome, lines);
  if (r.torque_couette_reference)
    lines.push_back(
        fmt::format("cylinder        {:.4g} N.m for a solid cylinder by the law's Couette flow: the torque "
                    "is {:.3f} of it",
                    *r.torque_couette_reference, r.torque_end / *r.torque_couette_reference));
  else if (scene.with_reference && scene.speed != 0.0 && scene.speeds.empty() && !has_integrated_references())
    lines.push_back("cylinder        not known: built without SUNDIALS; apt-get install libsundials-dev");
  if (r.end_factor)
    lines.push_back(fmt::format(
        "ends            the torque is {:.4g} times {:.4g} N.m, the plane section's of the same height",
        *r.end_factor, *r.torque_plane));
  add_comparison(scene, r, lines);
  if (r.alpha_apparent)
    lines.push_back(
        fmt::format("                apparent alpha over {:.3g} s, with the nominal shear rate {:.4g} 1/s",
                    r.alpha_window, r.shear_rate_nominal));
  return lines;
}

}  // namespace tremie::scene
