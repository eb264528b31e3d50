#include <fmt/format.h>

#include <cmath>

#include "apparatus/common/outcome_parts.hpp"
#include "apparatus/slump_flow/scene.hpp"

namespace tremie::scene {
namespace {

// Accepted for tremie concrete by the sources of Wilkes, Kumar and Biscontin (EFFC/DFI).
constexpr double tremie_range_low = 0.450, tremie_range_high = 0.650;

bool in_tremie_range(double spread) { return spread >= tremie_range_low && spread <= tremie_range_high; }

ResultValue class_of(double spread) {
  return word_or_null(std::isfinite(spread) ? slump_flow::spread_class(spread) : "");
}

std::vector<Result> results_of(const slump_flow::Results& r) {
  return {{"spread_mm", number(r.spread, mm)},
          {"spread_max_point_mm", number(r.spread_max_point, mm)},
          {"height_mm", number(r.height, mm)},
          {"t500_s", number(r.t500)},
          {"stopped_at_s", number(r.stopped_at)},
          {"class_en12350_8", class_of(r.spread)},
          {"flocculation_mean_start", number(r.flocculation_mean_start)},
          {"flocculation_mean_end", number(r.flocculation_mean_end)},
          {"shear_rate_mean_peak_per_s", number(r.shear_rate_mean_peak)},
          {"mean_velocity_mm_per_s", number(r.mean_velocity, mm)},
          {"within_tremie_range", in_tremie_range(r.spread)}};
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

/// What was measured after the rest that this scene has; nothing for any other rest.
std::vector<Reference> references_for(double rest, const Measured& measured) {
  const auto& value = rest == 0.0 ? measured.slump_flow_0 : measured.slump_flow_240;
  if (!value || (rest != 0.0 && rest != 240.0)) return {};
  return {{"measured", *value * mm, measured.tolerance * mm}};
}

std::vector<Chart> charts_of(const slump_flow::Scene& scene, const Measured& measured) {
  std::vector<Chart> charts{{"spread.svg",
                             "Spread",
                             "time since the start of the lift / s",
                             "spread / mm",
                             {"spread_mm"},
                             references_for(scene.rest, measured)}};
  charts.push_back({"shear_rate.svg",
                    "Mean shear rate",
                    "time since the start of the lift / s",
                    "volume mean of the shear rate / (1/s)",
                    {"shear_rate_mean_per_s"},
                    {}});
  if (scene.mix.thixotropy) {
    charts.push_back({"flocculation.svg",
                      "Flocculation",
                      "time since the start of the lift / s",
                      "volume mean of the flocculation state",
                      {"flocculation_mean"},
                      {}});
  }
  return charts;
}

std::vector<std::string> lines_for(const slump_flow::Scene& scene, const Measured& measured,
                                   const slump_flow::Results& r) {
  const std::string cls = std::isfinite(r.spread) ? slump_flow::spread_class(r.spread) : "";
  std::vector<std::string> lines{
      fmt::format("spread          {:.0f} mm   class {}", r.spread * mm,
                  cls.empty() ? "none of SF1 to SF3" : cls),
      fmt::format("height          {:.0f} mm", r.height * mm),
      fmt::format("t500            {}", seconds_or(r.t500, "never reached")),
      fmt::format("stopped at      {}", seconds_or(r.stopped_at, "still moving at the end"))};
  if (r.mean_velocity) lines.push_back(fmt::format("mean velocity   {:.1f} mm/s", *r.mean_velocity * mm));
  lines.push_back(fmt::format("tremie concrete {} the accepted 450 to 650 mm",
                              in_tremie_range(r.spread) ? "within" : "outside of"));
  add_flocculation_line(r.flocculation_mean_start, r.flocculation_mean_end, lines);
  for (const auto& reference : references_for(scene.rest, measured))
    lines.push_back(
        fmt::format("measured        {:.0f} mm, +/- {:.0f} mm", reference.value, reference.tolerance));
  return lines;
}

slump_flow::Observer observe(const slump_flow::Scene& scene, bool all_frames, const Observer& observer) {
  slump_flow::Observer result;
  result.interrupted = observer.interrupted;
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
  outcome.results = results_of(raw.results);
  outcome.checks = std::move(raw.checks);
  outcome.cost = raw.cost;
  outcome.series = columns_of(raw.series, scene.mix.thixotropy.has_value());
  outcome.charts = charts_of(scene, measured);
  outcome.lines = lines_for(scene, measured, raw.results);
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
