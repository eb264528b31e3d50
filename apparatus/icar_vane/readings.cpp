#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/common/flow_readings.hpp"
#include "apparatus/icar_vane/ends.hpp"
#include "apparatus/icar_vane/instrument.hpp"
#include "rheometer/reference/instrument.hpp"
#include "rheometer/reference/references.hpp"

namespace tremie::icar_vane {

using namespace scene;

namespace {

constexpr const char* time_label = "time since the vane began to turn (s)";

/// The concrete as the vane meets it.
struct VaneInput {
  double yield_stress = 0.0;                            ///< [Pa]
  double plastic_viscosity = 0.0;                       ///< [Pa s]; not a number for a law that has none
  double static_yield_stress = 0.0;                     ///< (1 + lambda) tau_0 after the rest [Pa]
  std::optional<double> flocculation = {}, alpha = {};  ///< lambda after the rest
};

VaneInput vane_input(const Scene& scene) {
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

struct View : RunView<Scene, Outcome> {
  const VaneInput in = vane_input(scene);
};

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

/// What went in beside what the instrument would report.
std::vector<std::string> comparison_lines(const View& v) {
  const auto& [scene, r, in] = std::tie(v.scene, v.r, v.in);
  std::vector<std::string> lines{fmt::format("{:<26}{:>12}{:>16}", "", "input", "instrument")};
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
  if (r.alpha_apparent)
    lines.push_back(
        fmt::format("                apparent alpha over {:.3g} s, with the nominal shear rate {:.4g} 1/s",
                    r.alpha_window, r.shear_rate_nominal));
  return lines;
}

/// Torque on the blades, on the container and from the power, which must agree but for the rate of angular
/// momentum.
std::vector<std::string> agreement_lines(const View& v) {
  const Results& r = v.r;
  const double momentum = v.series.empty() ? 0.0 : v.series.back().momentum_rate;
  const double scale = std::abs(r.torque_end) > 0.0 ? std::abs(r.torque_end) : 1.0;
  const double wall = (r.torque_wall_end + momentum) / scale - r.torque_end / scale;
  const double power = (r.torque_power_end - r.torque_end) / scale;
  std::vector<std::string> lines{
      fmt::format("on the wall     {:.4g} N.m ({:+.2f} % with the rate of angular momentum)   power/speed "
                  "{:.4g} N.m ({:+.2f} %)",
                  r.torque_wall_end, 100.0 * wall, r.torque_power_end, 100.0 * power)};
  if (std::max(std::abs(wall), std::abs(power)) > torques_must_agree)
    lines.push_back(
        "                the three torques differ by more than 1 %: not steady, or cells too large");
  return lines;
}

constexpr double told_inertia = 0.05;  ///< of the torque at the peak

std::vector<std::string> torque_lines(const View& v) {
  std::vector<std::string> lines{fmt::format("torque          {:.4g} N.m at its peak, {:.4g} N.m at the end",
                                             v.r.torque_peak, v.r.torque_end)};
  const double share = v.r.torque_peak != 0.0 ? v.r.inertia_at_peak / v.r.torque_peak : 0.0;
  if (v.scene.speeds.empty() && share > told_inertia)
    lines.push_back(fmt::format(
        "                {:.0f} % of the peak accelerate the concrete: values read from the peak are too "
        "large by this share",
        100.0 * share));
  return lines;
}

std::vector<std::string> cylinder_lines(const View& v) {
  const auto& reference = v.r.torque_couette_reference;
  if (reference)
    return {
        fmt::format("cylinder        {:.4g} N.m for a solid cylinder by the law's Couette flow: the torque "
                    "is {:.3f} of it",
                    *reference, v.r.torque_end / *reference)};
  if (v.scene.with_reference && v.scene.speed != 0.0 && v.scene.speeds.empty() &&
      !has_integrated_references())
    return {"cylinder        not known: built without SUNDIALS; apt-get install libsundials-dev"};
  return {};
}

std::vector<std::string> end_lines(const View& v) {
  if (!v.r.end_factor) return {};
  return {fmt::format(
      "ends            the torque is {:.4g} times {:.4g} N.m, the plane section's of the same height",
      *v.r.end_factor, *v.r.torque_plane)};
}

bool wall_slides(const View& v) { return slides(v.scene); }

/// What slides, by how much of the speed at its radius, and what an instrument makes of it.
std::vector<std::string> slip_lines(const View& v) {
  if (!slides(v.scene)) return {};
  const Vane& vane = v.scene.vane;
  const double radius = v.scene.cylinder_slides ? vane.radius : vane.container_radius;
  const double speed = v.series.empty() ? 0.0 : angular_speed(std::abs(v.series.back().speed)) * radius;
  return {fmt::format(
      "slip            {:.3g} mm/s along the {} at the end, {:.0f} % of the speed there without shear",
      1e3 * v.r.slip_end, v.scene.cylinder_slides ? "cylinder" : "container",
      speed > 0.0 ? 100.0 * v.r.slip_end / speed : 0.0)};
}

std::optional<double> if_alpha(const View& v, double value) {
  return v.r.alpha_apparent ? std::optional(value) : std::nullopt;
}

using V = const View&;
using S = const Sample&;

Rows<View> torque_rows() {
  return {
      {.name = "torque_peak_N_m",
       .words = "largest torque on the blades",
       .value = [](V v) { return number(v.r.torque_peak); },
       .label = "torque peak",
       .digits = 3,
       .answer =
           [](V v) { return v.r.reiner_riwlin ? std::nullopt : std::optional<std::string>("at its peak"); },
       .headline = 2,
       .headline_digits = 4,
       .measurable = true,
       .lines = torque_lines},
      {"torque_peak_inertia_N_m", "part of the largest torque that accelerates the concrete",
       [](V v) {
         return number(v.scene.speeds.empty() ? std::optional(v.r.inertia_at_peak) : std::nullopt);
       }},
      {.name = "torque_end_N_m",
       .words = "torque on the blades at the end",
       .value = [](V v) { return number(v.r.torque_end); },
       .label = "torque at the end",
       .digits = 3,
       .answer = [](V) { return std::optional<std::string>("torque at the end"); },
       .headline = 1,
       .headline_digits = 4,
       .measurable = true,
       .lines = agreement_lines},
      {"torque_wall_end_N_m", "torque on the container at the end",
       [](V v) { return number(v.r.torque_wall_end); }},
      {"torque_power_end_N_m", "dissipated power over speed at the end",
       [](V v) { return number(v.r.torque_power_end); }},
      {.name = "slip_end_m_per_s",
       .words = "speed of the concrete along the wall that slides, at the end",
       .value = [](V v) { return number(v.r.slip_end); },
       .applies = wall_slides,
       .lines = slip_lines}};
}

Rows<View> instrument_rows() {
  const auto has_curve = [](V v) { return v.r.reiner_riwlin.has_value(); };
  const Rows<View> of_a_curve{
      {"reiner_riwlin.yield_stress_Pa", "yield stress by Reiner-Riwlin, as the instrument reports",
       [](V v) { return number(v.r.reiner_riwlin->yield_stress); }},
      {"reiner_riwlin.plastic_viscosity_Pa_s",
       "plastic viscosity by Reiner-Riwlin, as the instrument reports",
       [](V v) { return number(v.r.reiner_riwlin->plastic_viscosity); }}};
  Rows<View> rows{
      {"flocculation_apparent_start", "flocculation state λ at the start, as read off the torque",
       [](V v) { return number(v.r.flocculation_apparent_start); }},
      {"alpha_apparent", "α as read off the decay", [](V v) { return number(v.r.alpha_apparent); }},
      {"alpha_window_s", "time over which α is read",
       [](V v) { return number(if_alpha(v, v.r.alpha_window)); }},
      {"shear_rate_nominal_per_s", "nominal shear rate 2Ω/(1 − r²/R²), by which α is read",
       [](V v) {
         return number(v.scene.speeds.empty() ? std::optional(v.r.shear_rate_nominal) : std::nullopt);
       }},
      {"static_yield_stress_apparent_Pa", "T/(2πr²h) at the peak: apparent static yield stress",
       [](V v) { return number(v.r.static_yield_stress_apparent); }},
      {"dynamic_yield_stress_apparent_Pa",
       "T/(2πr²h) at the end: apparent, with viscous part and flocculation left",
       [](V v) { return number(v.r.dynamic_yield_stress_apparent); }},
      {.name = "torque_couette_reference_N_m",
       .words = "torque of a solid cylinder in the same container (Couette flow)",
       .value = [](V v) { return number(v.r.torque_couette_reference); },
       .lines = cylinder_lines},
      {"torque_plane_N_m", "torque of the plane section times the height",
       [](V v) { return number(v.r.torque_plane); }},
      {.name = "end_factor",
       .words = "torque over that of the plane section",
       .value = [](V v) { return number(v.r.end_factor); },
       .lines = end_lines}};
  return table_of<View>(only_where<View>(has_curve, of_a_curve), rows);
}

/// What went in, to be read beside what the instrument would report.
Rows<View> input_rows() {
  return {{.name = "input.yield_stress_Pa",
           .words = "yield stress that went in",
           .value = [](V v) { return ResultValue(v.in.yield_stress); },
           .lines = comparison_lines},
          {"input.plastic_viscosity_Pa_s", "plastic viscosity that went in",
           [](V v) { return number(v.in.plastic_viscosity); }},
          {"input.flocculation_start", "flocculation state λ that went in",
           [](V v) { return number(v.in.flocculation); }},
          {"input.static_yield_stress_Pa", "static yield stress that went in",
           [](V v) { return ResultValue(v.in.static_yield_stress); }},
          {"input.destructuration", "α that went in", [](V v) { return number(v.in.alpha); }}};
}

Rows<View> torque_columns() {
  return {{"speed_rev_per_s", "speed of the vane", {}, [](V, S x) { return x.speed; }},
          {"torque_N_m", "torque on the blades", {}, [](V, S x) { return x.torque; }},
          {"torque_wall_N_m", "", {}, [](V, S x) { return x.torque_wall; }},
          {"torque_power_N_m", "", {}, [](V, S x) { return x.torque_power; }},
          {"momentum_rate_N_m", "", {}, [](V, S x) { return x.momentum_rate; }},
          {.name = "slip_m_per_s",
           .words = "speed along the wall that slides",
           .at = [](V, S x) { return x.slip; },
           .applies = wall_slides}};
}

const std::vector<Reading<View>>& readings() {
  static const auto table =
      table_of<View>(torque_rows(), instrument_rows(), input_rows(), time_column<View>(), torque_columns(),
                     shear_columns<View>(),
                     Rows<View>{{.name = "flocculation_apparent",
                                 .words = "flocculation state λ, as read off the torque",
                                 .at = [](V, S x) { return or_nan(x.flocculation_apparent); },
                                 .applies = is_thixotropic<View>}},
                     step_columns<View>());
  return table;
}

using P = ProfilePoint;
const TableOf<P> profile_table{
    "profile.csv",
    {{"radius_mm", "", [](const P& p) { return p.radius * mm; }},
     {"velocity_m_per_s", "", [](const P& p) { return p.velocity; }},
     {"shear_rate_per_s", "", [](const P& p) { return p.shear_rate; }},
     {"flocculation", "flocculation state λ", [](const P& p) { return or_nan(p.flocculation); }}}};
const TableOf<CurvePoint> curve_table{
    "flow_curve.csv",
    {{"speed_rev_per_s", "", [](const CurvePoint& p) { return std::abs(p.speed); }},
     {"torque_N_m", "", [](const CurvePoint& p) { return std::abs(p.torque); }}}};
const TableOf<Sample> record_table{
    "torque.csv",
    {{"time_s", "", [](S s) { return s.time; }}, {"torque_N_m", "", [](S s) { return std::abs(s.torque); }}}};

ResultTable profile_of(const std::vector<ProfilePoint>& profile) {
  ResultTable table = table_from(profile_table, profile);
  if (std::none_of(profile.begin(), profile.end(), [](const P& p) { return p.flocculation; }))
    table.columns.pop_back();
  return table;
}

/// Share of the torque that may accelerate the concrete in a reading of the record.
constexpr double steady_enough = 0.02;

/// The record as `tremie fit` reads it: magnitudes, and no reading before the vane has its speed and the concrete
/// has followed it: a torque that accelerates the concrete is none of its rheology.
ResultTable record_of(const Scene& scene, const Outcome& raw) {
  if (!scene.speeds.empty()) return table_from(curve_table, raw.results.flow_curve);
  const double direction = scene.speed < 0.0 ? -1.0 : 1.0;
  std::vector<Sample> record;
  const auto steady = std::find_if(raw.series.begin(), raw.series.end(), [&](const Sample& s) {
    return s.speed == scene.speed && direction * s.torque > 0.0 &&
           std::abs(s.momentum_rate) < steady_enough * std::abs(s.torque);
  });
  std::copy_if(steady, raw.series.end(), std::back_inserter(record),
               [&](const Sample& s) { return s.speed == scene.speed && direction * s.torque > 0.0; });
  return table_from(record_table, record);
}

Chart torque_chart(const Results& r, bool constant_speed) {
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

std::vector<Chart> charts_of(const Scene& scene, const Results& r) {
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

std::string test_text(const Scene& scene) {
  return scene.speeds.empty() ? fmt::format("vane at {:g} rev/s", scene.speed)
                              : fmt::format("vane, flow curve of {} speeds", scene.speeds.size());
}

/// How the instrument's readings are to be taken.
std::vector<std::string> remarks_on(const Scene& scene, const Results& r) {
  std::vector<std::string> remarks;
  if (r.reiner_riwlin)
    remarks.push_back(fmt::format(
        "From this curve an instrument reports a yield stress of {:.4g} Pa and a plastic viscosity of {:.4g} "
        "Pa·s; {:.4g} Pa and {:.4g} Pa·s went in.",
        r.reiner_riwlin->yield_stress, r.reiner_riwlin->plastic_viscosity, scene.mix.tau_0, scene.mix.mu));
  if (scene.mix.thixotropy && scene.rest > 0.0 && scene.speeds.empty())
    remarks.push_back(
        "The apparent yield stresses are T/(2πr²h), as the instrument reads them: in rested concrete the one "
        "at the end still holds what flocculation is left there and the viscous part, so it lies far above "
        "the dynamic yield stress that went in. It is what the instrument would say, not an error of the "
        "computation.");
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
std::vector<Outline> blades_of(const Vane& vane) {
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
std::optional<scene::Stage> stage_of(const Scene& scene, const std::vector<Sample>& series) {
  if (scene.model.space != SpaceKind::plane)
    return std::nullopt;  // with ends: no picture, the frames have it
  scene::Stage stage;
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

std::string flow_curve_use(const Scene& scene) {
  return scene.speeds.empty() ? "flow curve: left out (no test.speeds)"
                              : fmt::format("flow curve: {} speeds", scene.speeds.size());
}

void add_wall_uses(const Scene& scene, std::vector<std::string>& lines) {
  const std::optional<WallStress> stress = wall_stress(scene.walls);
  if (stress)
    lines.push_back(fmt::format("{}: a layer slides along it, {:g} Pa + {:g} Pa.s/m times its speed",
                                scene.cylinder_slides ? "cylinder" : "container", stress->yield,
                                stress->viscous));
}

/// Faces of the grid stand for shaft and gaps: where they are.
std::vector<std::string> uses_with_ends(const Scene& scene) {
  const EndsGrid grid(scene, true);
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(fmt::format("blades: {} of {:g} mm{}", scene.vane.blades, scene.vane.blade_thickness * mm,
                              grid.n_thick > 0
                                  ? ""
                                  : " in the plane section; in space, for the factor of the ends, sheets "
                                    "(thinner than half a cell)"));
  lines.push_back(fmt::format(
      "ends: {:.3g} mm to the floor, {:.3g} mm of cover, a shaft of {:.3g} mm (faces of the grid)",
      grid.bottom_gap() * mm, grid.cover() * mm, grid.shaft_radius() * mm));
  add_wall_uses(scene, lines);
  lines.push_back("surface: flat, slips; no vortex, no waves");
  lines.push_back("inertia: left out, steady flow at each speed");
  lines.push_back("third dimension: one blade's sector, which repeats");
  lines.push_back(flow_curve_use(scene));
  add_model_uses(scene.model, lines);
  return lines;
}

scene::Outcome run_and_read(Scene scene, const RunOptions& options, const Observer& observer) {
  scene.with_reference = scene.with_reference && !options.coarser;
  const Outcome raw = run(scene, observer);
  scene::Outcome outcome =
      outcome_of(readings(), View{{scene, raw}}, options.measured.name, test_text(scene));
  outcome.remarks = remarks_on(scene, raw.results);
  outcome.stage = stage_of(scene, raw.series);
  outcome.tables = {profile_of(raw.results.profile), record_of(scene, raw)};
  outcome.charts = charts_of(scene, raw.results);
  outcome.pictured = false;
  if (!std::isfinite(raw.results.torque_end))
    outcome.checks.reasons.push_back("the torque is not a finite number");
  return outcome;
}

std::vector<std::string> uses(const Scene& scene) {
  if (scene.model.space == SpaceKind::cylindrical) return uses_with_ends(scene);
  const bool plane = scene.model.space == SpaceKind::plane;
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(
      plane ? fmt::format("blades: {} of {:g} mm", scene.vane.blades, scene.vane.blade_thickness * mm)
            : "blades: left out (model.space = \"couette\"): the vane is a solid cylinder");
  for (std::string& line : localisation_use(scene)) lines.push_back(std::move(line));
  add_wall_uses(scene, lines);
  lines.push_back("end effects above and below the vane: neglected");
  lines.push_back("third dimension: left out (model.space)");
  lines.push_back(flow_curve_use(scene));
  add_model_uses(scene.model, lines);
  return lines;
}

}  // namespace

Apparatus apparatus() {
  return make_apparatus<Scene>(
      apparatus_of(keys(), "vane", readings(), profile_table, curve_table, record_table), read_scene, uses,
      run_and_read, estimate);
}

}  // namespace tremie::icar_vane
