#include "apparatus/icar_vane/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/common/outcome_parts.hpp"
#include "apparatus/icar_vane/ends.hpp"
#include "apparatus/icar_vane/lines.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie::scene {
namespace {

using icar_vane::CurvePoint;
using icar_vane::ProfilePoint;
using icar_vane::Sample;

constexpr const char* time_label = "time since the vane began to turn (s)";

/// What went in, to be read beside what the instrument would report.
std::vector<Result> input_of(const icar_vane::Scene& scene) {
  const VaneInput in = vane_input(scene);
  return {{"yield_stress_Pa", in.yield_stress},
          {"plastic_viscosity_Pa_s", number(in.plastic_viscosity)},
          {"flocculation_start", number(in.flocculation)},
          {"static_yield_stress_Pa", in.static_yield_stress},
          {"destructuration", number(in.alpha)}};
}

ResultValue reiner_riwlin_of(const std::optional<icar_vane::ReinerRiwlin>& r) {
  if (!r) return std::monostate{};
  return std::vector<Result>{{"yield_stress_Pa", number(r->yield_stress)},
                             {"plastic_viscosity_Pa_s", number(r->plastic_viscosity)}};
}

std::vector<Result> results_of(const icar_vane::Scene& scene, const icar_vane::Results& r) {
  const auto window = r.alpha_apparent ? std::optional(r.alpha_window) : std::nullopt;
  const auto nominal = scene.speeds.empty() ? std::optional(r.shear_rate_nominal) : std::nullopt;
  return {{"torque_peak_N_m", number(r.torque_peak)},
          {"torque_end_N_m", number(r.torque_end)},
          {"torque_wall_end_N_m", number(r.torque_wall_end)},
          {"torque_power_end_N_m", number(r.torque_power_end)},
          {"reiner_riwlin", reiner_riwlin_of(r.reiner_riwlin)},
          {"flocculation_apparent_start", number(r.flocculation_apparent_start)},
          {"alpha_apparent", number(r.alpha_apparent)},
          {"alpha_window_s", number(window)},
          {"shear_rate_nominal_per_s", number(nominal)},
          {"static_yield_stress_apparent_Pa", number(r.static_yield_stress_apparent)},
          {"dynamic_yield_stress_apparent_Pa", number(r.dynamic_yield_stress_apparent)},
          {"torque_couette_reference_N_m", number(r.torque_couette_reference)},
          {"torque_plane_N_m", number(r.torque_plane)},
          {"end_factor", number(r.end_factor)},
          {"input", input_of(scene)}};
}

std::vector<Column> series_of(const std::vector<Sample>& s, bool thixotropic) {
  std::vector<Column> columns{
      column("time_s", s, [](const Sample& x) { return x.time; }),
      column("speed_rev_per_s", s, [](const Sample& x) { return x.speed; }),
      column("torque_N_m", s, [](const Sample& x) { return x.torque; }),
      column("torque_wall_N_m", s, [](const Sample& x) { return x.torque_wall; }),
      column("torque_power_N_m", s, [](const Sample& x) { return x.torque_power; }),
      column("momentum_rate_N_m", s, [](const Sample& x) { return x.momentum_rate; }),
      column("shear_rate_mean_per_s", s, [](const Sample& x) { return x.shear_rate_mean; })};
  if (thixotropic) {
    columns.push_back(
        column("flocculation_mean", s, [](const Sample& x) { return or_nan(x.flocculation_mean); }));
    columns.push_back(
        column("flocculation_apparent", s, [](const Sample& x) { return or_nan(x.flocculation_apparent); }));
  }
  columns.push_back(column("time_step_s", s, [](const Sample& x) { return x.time_step; }));
  columns.push_back(
      column("iterations", s, [](const Sample& x) { return static_cast<double>(x.iterations); }));
  return columns;
}

ResultTable profile_of(const std::vector<ProfilePoint>& profile) {
  using P = ProfilePoint;
  ResultTable table{"profile.csv",
                    {column("radius_mm", profile, [](const P& p) { return p.radius * mm; }),
                     column("velocity_m_per_s", profile, [](const P& p) { return p.velocity; }),
                     column("shear_rate_per_s", profile, [](const P& p) { return p.shear_rate; })}};
  const bool thixotropic =
      std::any_of(profile.begin(), profile.end(), [](const P& p) { return p.flocculation; });
  if (thixotropic)
    table.columns.push_back(
        column("flocculation", profile, [](const P& p) { return or_nan(p.flocculation); }));
  return table;
}

/// Share of the torque that may accelerate the concrete in a reading of the record.
constexpr double steady_enough = 0.02;

/// The record as `tremie fit` reads it: magnitudes, and no reading before the vane has its speed and the concrete
/// has followed it: a torque that accelerates the concrete is none of its rheology.
ResultTable record_of(const icar_vane::Scene& scene, const icar_vane::Outcome& raw) {
  if (!scene.speeds.empty()) {
    const auto& curve = raw.results.flow_curve;
    return {"flow_curve.csv",
            {column("speed_rev_per_s", curve, [](const CurvePoint& p) { return std::abs(p.speed); }),
             column("torque_N_m", curve, [](const CurvePoint& p) { return std::abs(p.torque); })}};
  }
  const double direction = scene.speed < 0.0 ? -1.0 : 1.0;
  std::vector<Sample> record;
  const auto steady = std::find_if(raw.series.begin(), raw.series.end(), [&](const Sample& s) {
    return s.speed == scene.speed && direction * s.torque > 0.0 &&
           std::abs(s.momentum_rate) < steady_enough * std::abs(s.torque);
  });
  std::copy_if(steady, raw.series.end(), std::back_inserter(record),
               [&](const Sample& s) { return s.speed == scene.speed && direction * s.torque > 0.0; });
  return {"torque.csv",
          {column("time_s", record, [](const Sample& s) { return s.time; }),
           column("torque_N_m", record, [&](const Sample& s) { return direction * s.torque; })}};
}

Chart torque_chart(const icar_vane::Results& r, bool constant_speed) {
  Chart chart{"torque.svg",
              "Torque",
              time_label,
              "torque (N·m)",
              {"torque_N_m", "torque_wall_N_m", "torque_power_N_m"},
              {},
              {"on the blades", "on the container", "power / speed"}};
  if (constant_speed && r.torque_couette_reference)
    chart.references.push_back({"solid cylinder at the end", *r.torque_couette_reference, 0.0});
  return chart;
}

Chart profile_chart(const char* file, const char* title, const char* y_label, const char* name) {
  return {file, title, "radius (mm)", y_label, {name}, {}, {}, "profile.csv"};
}

std::vector<Chart> charts_of(const icar_vane::Scene& scene, const icar_vane::Results& r) {
  std::vector<Chart> charts{torque_chart(r, scene.speeds.empty()),
                            profile_chart("shear_rate_profile.svg", "Shear rate at the end",
                                          "shear rate (1/s)", "shear_rate_per_s")};
  if (!scene.speeds.empty())
    charts.push_back({"flow_curve.svg",
                      "Flow curve",
                      "speed (rev/s)",
                      "torque (N·m)",
                      {"torque_N_m"},
                      {},
                      {},
                      "flow_curve.csv"});
  if (!scene.mix.thixotropy) return charts;
  charts.push_back(profile_chart("flocculation_profile.svg", "Flocculation at the end",
                                 "flocculation state λ", "flocculation"));
  charts.push_back({"flocculation.svg",
                    "Flocculation",
                    time_label,
                    "flocculation state λ",
                    {"flocculation_mean", "flocculation_apparent"},
                    {},
                    {"volume mean", "apparent, from the torque"}});
  return charts;
}

std::string test_text(const icar_vane::Scene& scene) {
  return scene.speeds.empty() ? fmt::format("vane at {:g} rev/s", scene.speed)
                              : fmt::format("vane, flow curve of {} speeds", scene.speeds.size());
}

std::vector<Answer> answers_of(const icar_vane::Results& r) {
  if (r.reiner_riwlin) return {{"torque_end_N_m", "torque at the end", "N·m", 3}};
  return {{"torque_peak_N_m", "torque at its peak", "N·m", 3}, {"torque_end_N_m", "at the end", "N·m", 3}};
}

/// How the instrument's readings are to be taken.
std::vector<std::string> remarks_on(const icar_vane::Scene& scene, const icar_vane::Results& r) {
  std::vector<std::string> remarks;
  if (r.reiner_riwlin)
    remarks.push_back(fmt::format(
        "From this curve an instrument reports a yield stress of {:.4g} Pa and a plastic viscosity of "
        "{:.4g} Pa·s; {:.4g} Pa and {:.4g} Pa·s went in.",
        r.reiner_riwlin->yield_stress, r.reiner_riwlin->plastic_viscosity, scene.mix.tau_0, scene.mix.mu));
  if (scene.mix.thixotropy && scene.rest > 0.0 && scene.speeds.empty())
    remarks.push_back(
        "The apparent yield stresses are T/(2πr²h), as the instrument reads them: in rested concrete the one "
        "at the "
        "end still holds what flocculation is left there and the viscous part, so it lies far above the "
        "dynamic "
        "yield stress that went in. It is what the instrument would say, not an error of the computation.");
  return remarks;
}

Outline circle_of(double radius) {
  Outline circle;
  for (int i = 0; i <= 96; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 96.0;
    circle.push_back({radius * std::cos(a), radius * std::sin(a)});
  }
  return circle;
}

/// Shaft and blades as they stand at the start, the first along x.
std::vector<Outline> blades_of(const icar_vane::Vane& vane) {
  std::vector<Outline> outlines{circle_of(vane.shaft_radius)};
  const double half = 0.5 * vane.blade_thickness;
  for (int b = 0; b < vane.blades; ++b) {
    const double a = 2.0 * std::numbers::pi * b / vane.blades, c = std::cos(a), s = std::sin(a);
    Outline blade;
    for (const auto& [r, t] :
         {std::array{0.0, -half}, {vane.radius, -half}, {vane.radius, half}, {0.0, half}, {0.0, -half}})
      blade.push_back({c * r - s * t, s * r + c * t});
    outlines.push_back(blade);
  }
  return outlines;
}

/// Blades in the plane have a shape to be seen; a solid cylinder's section is a line.
std::optional<Stage> stage_of(const icar_vane::Scene& scene, const std::vector<Sample>& series) {
  if (scene.model.space != SpaceKind::plane)
    return std::nullopt;  // with ends: no picture, the frames have it
  Stage stage;
  stage.up = 1, stage.depth = 2;
  stage.walls = {circle_of(scene.vane.container_radius)};
  stage.point_size = scene.model.cell[0] / scene.model.points_per_cell[0];
  stage.full = true;
  stage.turning = blades_of(scene.vane);
  stage.turned = {{0.0, 0.0}};
  for (const Sample& s : series) {
    const auto [time, angle] = stage.turned.back();
    stage.turned.push_back({s.time, angle + angular_speed(s.speed) * (s.time - time)});
  }
  return stage;
}

double whole_time(const icar_vane::Scene& scene) {
  if (scene.speeds.empty()) return scene.duration;
  return scene.pre_shear_time + static_cast<double>(scene.speeds.size()) * scene.hold_time;
}

std::string flow_curve_use(const icar_vane::Scene& scene) {
  return scene.speeds.empty() ? "flow curve: left out (no test.speeds)"
                              : fmt::format("flow curve: {} speeds", scene.speeds.size());
}

/// Faces of the grid stand for shaft and gaps: where they are.
std::vector<std::string> uses_with_ends(const icar_vane::Scene& scene) {
  const icar_vane::EndsGrid grid(scene, true);
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(
      grid.n_thick > 0
          ? fmt::format("blades: {} of {:g} mm", scene.vane.blades, scene.vane.blade_thickness * mm)
          : fmt::format("blades: {} without thickness (thinner than half a cell); 3 mm of the "
                        "ICAR's take 3 % more",
                        scene.vane.blades));
  lines.push_back(fmt::format(
      "ends: {:.3g} mm to the floor, {:.3g} mm of cover, a shaft of {:.3g} mm (faces of the grid)",
      grid.bottom_gap() * mm, grid.cover() * mm, grid.shaft_radius() * mm));
  lines.push_back("surface: flat, slips; no vortex, no waves");
  lines.push_back("inertia: left out, steady flow at each speed");
  lines.push_back("third dimension: one blade's sector, which repeats");
  lines.push_back(flow_curve_use(scene));
  add_model_uses(scene.model, lines);
  return lines;
}

icar_vane::Observer observe(double duration, bool all_frames, const Observer& observer) {
  icar_vane::Observer result;
  result.interrupted = observer.interrupted;
  result.checkpoints = observer.checkpoints;
  if (all_frames) result.on_frame = observer.on_frame;
  if (observer.on_progress) {
    result.on_step = [duration, &observer](const Sample& s) {
      observer.on_progress({s.time, duration, s.time_step, fmt::format("torque {:.3f} N.m", s.torque)});
    };
  }
  return result;
}

}  // namespace

Outcome run_icar_vane(const icar_vane::Scene& scene, const Measured& measured, bool all_frames,
                      const Observer& observer) {
  icar_vane::Outcome raw = icar_vane::run(scene, observe(whole_time(scene), all_frames, observer));
  if (!all_frames && observer.on_frame) observer.on_frame(raw.final_frame);
  Outcome outcome;
  outcome.apparatus = "icar_vane";
  outcome.status = raw.status;
  outcome.results = results_of(scene, raw.results);
  outcome.checks = std::move(raw.checks);
  outcome.cost = raw.cost;
  outcome.series = series_of(raw.series, scene.mix.thixotropy.has_value());
  outcome.asked = asked_text(measured.name, test_text(scene), rest_told(scene));
  outcome.answers = answers_of(raw.results);
  outcome.remarks = remarks_on(scene, raw.results);
  outcome.stage = stage_of(scene, raw.series);
  outcome.tables = {profile_of(raw.results.profile), record_of(scene, raw)};
  outcome.charts = charts_of(scene, raw.results);
  outcome.lines = vane_lines(scene, raw);
  outcome.pictured = false;
  if (!std::isfinite(raw.results.torque_end))
    outcome.checks.reasons.push_back("the torque is not a finite number");
  return outcome;
}

std::vector<std::string> icar_vane_uses(const icar_vane::Scene& scene) {
  if (scene.model.space == SpaceKind::cylindrical) return uses_with_ends(scene);
  const bool plane = scene.model.space == SpaceKind::plane;
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(
      plane ? fmt::format("blades: {} of {:g} mm", scene.vane.blades, scene.vane.blade_thickness * mm)
            : "blades: left out (model.space = \"couette\"): the vane is a solid cylinder");
  lines.push_back("end effects above and below the vane: neglected");
  lines.push_back("third dimension: left out (model.space)");
  lines.push_back(flow_curve_use(scene));
  add_model_uses(scene.model, lines);
  return lines;
}

}  // namespace tremie::scene
