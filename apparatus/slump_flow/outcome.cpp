#include <fmt/format.h>

#include <cmath>

#include "apparatus/common/outcome_parts.hpp"
#include "apparatus/slump_flow/scene.hpp"

namespace tremie::scene {
namespace {

// Accepted for tremie concrete by the sources of Wilkes, Kumar and Biscontin (EFFC/DFI).
constexpr const char* time_label = "time since the start of the lift (s)";
constexpr double tremie_range_low = 0.450, tremie_range_high = 0.650;

bool in_tremie_range(double spread) { return spread >= tremie_range_low && spread <= tremie_range_high; }

bool stopped(const slump_flow::Results& r) { return r.stopped_at.has_value() && std::isfinite(r.spread); }

/// A class is that of concrete at rest.
std::string class_of(const slump_flow::Results& r) {
  return stopped(r) ? slump_flow::spread_class(r.spread) : std::string{};
}

/// Read to 10 mm, as the standard has it, so that SF1 begins at 545 mm.
bool is_below(const slump_flow::Results& r) { return r.spread < 0.545; }

ResultValue range_of(const slump_flow::Results& r) {
  if (!stopped(r)) return std::monostate{};
  return in_tremie_range(r.spread);
}

std::vector<Result> results_of(const slump_flow::Results& r) {
  return {{"spread_mm", number(r.spread, mm)},
          {"spread_max_point_mm", number(r.spread_max_point, mm)},
          {"height_mm", number(r.height, mm)},
          {"t500_s", number(r.t500)},
          {"stopped_at_s", number(r.stopped_at)},
          {"class_en12350_8", word_or_null(class_of(r))},
          {"flocculation_mean_start", number(r.flocculation_mean_start)},
          {"flocculation_mean_end", number(r.flocculation_mean_end)},
          {"shear_rate_mean_peak_per_s", number(r.shear_rate_mean_peak)},
          {"mean_velocity_mm_per_s", number(r.mean_velocity, mm)},
          {"within_tremie_range", range_of(r)}};
}

std::vector<Column> columns_of(const std::vector<slump_flow::Sample>& s, bool thixotropic) {
  using Sample = slump_flow::Sample;
  std::vector<Column> columns{
      column("time_s", s, [](const Sample& x) { return x.time; }),
      column("spread_mm", s, [](const Sample& x) { return x.spread * mm; }),
      column("spread_max_point_mm", s, [](const Sample& x) { return x.spread_max_point * mm; }),
      column("height_mm", s, [](const Sample& x) { return x.height * mm; }),
      column("max_speed_m_per_s", s, [](const Sample& x) { return x.max_speed; }),
      column("shear_rate_mean_per_s", s, [](const Sample& x) { return x.shear_rate_mean; })};
  if (thixotropic) {
    columns.push_back(
        column("flocculation_mean", s, [](const Sample& x) { return or_nan(x.flocculation_mean); }));
  }
  columns.push_back(column("volume_change", s, [](const Sample& x) { return x.volume_change; }));
  columns.push_back(column("kinetic_energy_J", s, [](const Sample& x) { return x.kinetic_energy; }));
  columns.push_back(column("time_step_s", s, [](const Sample& x) { return x.time_step; }));
  columns.push_back(
      column("iterations", s, [](const Sample& x) { return static_cast<double>(x.iterations); }));
  return columns;
}

/// What was measured after the rest that this scene has; nothing for any other rest. [measured] wins.
std::optional<Measurement> measurement_for(double rest, const Measured& measured, double spread) {
  std::optional<double> value = measured.spread;
  double tolerance = measured.spread_tolerance.value_or(0.03);
  if (!value) {
    if (rest == 0.0) value = measured.slump_flow_0;
    if (rest == 240.0) value = measured.slump_flow_240;
    tolerance = measured.tolerance;
  }
  if (!value) return std::nullopt;
  return Measurement{"spread_mm",
                     "spread",
                     "mm",
                     *value * mm,
                     tolerance * mm,
                     (spread - *value) * mm,
                     measured.spread ? std::string{} : measured.on};
}

std::vector<Reference> references_for(const std::optional<Measurement>& measured) {
  if (!measured) return {};
  const std::string label = measured->on.empty() ? "measured" : "measured on " + measured->on;
  return {{label, measured->value, measured->tolerance}};
}

/// results.measured; null without a measurement.
ResultValue measured_result(const std::optional<Measurement>& m, const Measured& measured,
                            const slump_flow::Results& r) {
  std::vector<Result> results;
  if (m)
    results = {
        {"spread_mm", m->value}, {"tolerance_mm", m->tolerance}, {"difference_mm", number(m->difference)}};
  if (measured.t500) {
    results.push_back({"t500_s", *measured.t500});
    results.push_back({"t500_difference_s", r.t500 ? number(*r.t500 - *measured.t500) : std::monostate{}});
  }
  if (results.empty()) return std::monostate{};
  return results;
}

/// Concrete that hardly left the cone's own foot and height.
bool kept_its_shape(const slump_flow::Results& r, const slump_flow::Cone& cone) {
  return r.spread < 2.1 * cone.bottom_radius && r.height > 0.9 * cone.height;
}

/// Class and accepted range; only of concrete at rest.
std::string judged(const slump_flow::Results& r, const slump_flow::Cone& cone) {
  if (!stopped(r)) return {};
  if (kept_its_shape(r, cone))
    return "It kept the cone's shape: too stiff for a slump flow, which has nothing to read from it.";
  const std::string cls = class_of(r);
  std::string text = !cls.empty()  ? fmt::format("Class {} of EN 206 (the spread read to 10 mm)", cls)
                     : is_below(r) ? "Below the classes of self-compacting concrete (SF1 begins at 550 mm)"
                                   : "Above the classes of self-compacting concrete (SF3 ends at 850 mm)";
  return text + (in_tremie_range(r.spread)
                     ? "; within the 450 to 650 mm that are accepted for tremie concrete."
                     : "; outside of the 450 to 650 mm that are accepted for tremie concrete.");
}

/// Why a spread may differ from the measured one although the computation is right.
constexpr const char* why_it_may_differ =
    "A difference from a measured spread beyond the error of the computation lies in what went in: yield "
    "stress and viscosity "
    "come from a rheometer, and instruments differ by factors; the destructuration α says how much of what "
    "built up at rest "
    "survives the lift, and one value for all concretes is a guess; the plate may hold the concrete or let "
    "it slip "
    "(floor.contact). tremie calibrate looks for the values that meet the measurements.";

/// Whether t500, or that there is none, hangs on the last millimetres: below 514 mm estimates from a t500 end too.
bool near_500(const slump_flow::Results& r) { return stopped(r) && std::abs(r.spread - 0.5) < 0.014; }

/// What a reader must know who has no measurement to compare with, or a spread that is hard to read.
std::vector<std::string> remarks_on(const slump_flow::Scene& scene,
                                    const std::optional<Measurement>& measured,
                                    const slump_flow::Results& r) {
  std::vector<std::string> remarks;
  if (measured && measured->on.empty())
    remarks.push_back(why_it_may_differ);
  else
    remarks.push_back(
        "Not compared with a measurement. With a rheometer's values the spreads of three measured concretes "
        "were computed 5 to 12 % short fresh, and some 40 % after 240 s of rest; values estimated from a "
        "spread leave that difference out.");
  const auto alpha = scene.mix.thixotropy ? destructuration(scene.mix.thixotropy->kinetics) : std::nullopt;
  if (scene.rest > 0.0 && alpha && !(measured && measured->on.empty()))
    remarks.push_back(fmt::format(
        "The destructuration α (here {:.3g}) decides how much of what built up at rest is left after the "
        "lift. It is seldom measured: see what 0.01 and 1 give.",
        *alpha));
  if (near_500(r))
    remarks.push_back(
        "The spread ends so near to 500 mm that t500, or whether there is one, hangs on its last "
        "millimetres: finer cells may change it by a third.");
  return remarks;
}

Stage stage_of(const slump_flow::Scene& scene) {
  Stage stage;
  stage.mirrored = scene.model.space != SpaceKind::full;
  stage.slice = scene.model.space == SpaceKind::axisymmetric ? 0.0 : scene.model.cell[0];
  if (scene.lift_speed) {
    stage.lifted = {{{scene.cone.bottom_radius, 0.0}, {scene.cone.top_radius, scene.cone.height}}};
    stage.lift_speed = *scene.lift_speed;
    if (!stage.mirrored)
      stage.lifted.push_back({{-scene.cone.bottom_radius, 0.0}, {-scene.cone.top_radius, scene.cone.height}});
  }
  const double across = scene.model.cell[0] / scene.model.points_per_cell[0];
  stage.point_size = std::max(across, scene.model.cell[1] / scene.model.points_per_cell[1]);
  stage.plan = "spread_mm";
  stage.ring_diameter = 0.5;
  return stage;
}

std::vector<Chart> charts_of(const slump_flow::Scene& scene, const std::optional<Measurement>& measured) {
  std::vector<Chart> charts{
      {"spread.svg", "Spread", time_label, "spread (mm)", {"spread_mm"}, references_for(measured)}};
  charts.push_back({"shear_rate.svg",
                    "Mean shear rate",
                    time_label,
                    "mean shear rate (1/s)",
                    {"shear_rate_mean_per_s"},
                    {}});
  if (scene.mix.thixotropy) {
    charts.push_back({"flocculation.svg",
                      "Flocculation",
                      time_label,
                      "mean flocculation state λ",
                      {"flocculation_mean"},
                      {}});
  }
  return charts;
}

std::string no_class(const slump_flow::Results& r, Status status) {
  if (stopped(r)) return is_below(r) ? "below class SF1 (550 mm)" : "above class SF3 (850 mm)";
  return ended_early(status) ? "so far: no class" : "no class yet: it still moves";
}

std::string class_text(const slump_flow::Results& r, Status status) {
  const std::string cls = class_of(r);
  return cls.empty() ? no_class(r, status) : "class " + cls + " (read to 10 mm)";
}

const char* not_reached(Status status) { return ended_early(status) ? "not reached yet" : "never reached"; }

std::vector<std::pair<std::string, std::string>> words_for_none(const slump_flow::Results& r, Status status) {
  return {{"class_en12350_8", no_class(r, status)},
          {"t500_s", not_reached(status)},
          {"stopped_at_s", still_moving(status)},
          {"within_tremie_range", "not yet known: it still moved"}};
}

std::vector<std::string> lines_for(const slump_flow::Results& r, Status status) {
  std::vector<std::string> lines{
      fmt::format("spread          {:.0f} mm   {}", r.spread * mm, class_text(r, status)),
      fmt::format("height          {:.0f} mm", r.height * mm),
      fmt::format("t500            {}{}", seconds_or(r.t500, not_reached(status)),
                  near_500(r) ? "   not to be relied on: the spread ends too near to 500 mm" : ""),
      stopped_line(r.stopped_at, status)};
  if (stopped(r))
    lines.push_back(fmt::format("tremie concrete {} the accepted 450 to 650 mm",
                                in_tremie_range(r.spread) ? "within" : "outside of"));
  add_flocculation_line(r.flocculation_mean_start, r.flocculation_mean_end, lines);
  return lines;
}

slump_flow::Observer observe(const slump_flow::Scene& scene, bool all_frames, const Observer& observer) {
  slump_flow::Observer result;
  result.interrupted = observer.interrupted;
  result.checkpoints = observer.checkpoints;
  if (all_frames) result.on_frame = observer.on_frame;
  if (observer.on_progress) {
    result.on_step = [&scene, &observer](const slump_flow::Sample& s) {
      observer.on_progress(
          {s.time, scene.duration, s.time_step, fmt::format("spread {:.0f} mm", s.spread * mm)});
    };
  }
  return result;
}

}  // namespace

Outcome run_slump_flow(const slump_flow::Scene& scene, const Measured& measured, bool all_frames,
                       const Observer& observer) {
  slump_flow::Outcome raw = slump_flow::run(scene, observe(scene, all_frames, observer));
  if (!all_frames && observer.on_frame) observer.on_frame(raw.final_frame);
  Outcome outcome;
  outcome.apparatus = "slump_flow";
  outcome.status = raw.status;
  outcome.measured = measurement_for(scene.rest, measured, raw.results.spread);
  outcome.results = results_of(raw.results);
  outcome.results.push_back({"measured", measured_result(outcome.measured, measured, raw.results)});
  outcome.asked = asked_text(measured.name, "slump flow", rest_told(scene));
  outcome.answers = {{"spread_mm", "", "mm", 0}};
  outcome.moving_at_end = !raw.results.stopped_at;
  outcome.judged = judged(raw.results, scene.cone);
  outcome.remarks = remarks_on(scene, outcome.measured, raw.results);
  outcome.stage = stage_of(scene);
  outcome.checks = std::move(raw.checks);
  outcome.cost = raw.cost;
  outcome.series = columns_of(raw.series, scene.mix.thixotropy.has_value());
  outcome.charts = charts_of(scene, outcome.measured);
  outcome.lines = lines_for(raw.results, raw.status);
  outcome.none = words_for_none(raw.results, raw.status);
  outcome.axisymmetric = scene.model.space == SpaceKind::axisymmetric;
  if (!std::isfinite(raw.results.spread))
    outcome.checks.reasons.push_back("the spread is not a finite number");
  return outcome;
}

std::vector<std::string> slump_flow_uses(const slump_flow::Scene& scene) {
  const Model& model = scene.model;
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(scene.floor.contact == ContactKind::friction
                      ? "floor friction: Coulomb's, at every floor node"
                      : "floor friction: left out (floor.contact)");
  lines.push_back(scene.lift_speed ? "cone: a moving rigid wall"
                                   : "cone: left out (test.lift_speed = \"instant\")");
  lines.push_back(model.space == SpaceKind::axisymmetric
                      ? "third dimension: left out (model.space = \"axisymmetric\")"
                      : "third dimension: computed");
  add_model_uses(model, lines);
  return lines;
}

}  // namespace tremie::scene
