#include "apparatus/l_box/outcome.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apparatus/common/outcome_parts.hpp"

namespace tremie::scene {
namespace {

constexpr const char* time_label = "time since the start of the lift (s)";

std::string class_of(const l_box::Scene& scene, const l_box::Results& r) {
  if (!r.stopped_at) return "";  // a class is that of concrete at rest
  return r.passing_ratio ? l_box::passing_class(*r.passing_ratio, scene.bars) : "";
}

std::vector<Result> results_of(const l_box::Scene& scene, const l_box::Results& r) {
  return {{"h1_mm", number(r.h1, mm)},
          {"h2_mm", number(r.h2, mm)},
          {"passing_ratio", number(r.passing_ratio)},
          {"passing_ratio_change_per_min", number(r.ratio_change, 60.0)},
          {"t200_s", number(r.t200)},
          {"t400_s", number(r.t400)},
          {"class_en12350_10", word_or_null(class_of(scene, r))},
          {"stopped_at_s", number(r.stopped_at)},
          {"flocculation_mean_start", number(r.flocculation_mean_start)},
          {"flocculation_mean_end", number(r.flocculation_mean_end)},
          {"volume_in_channel_m3", number(r.volume_in_channel)},
          {"bars", number(static_cast<double>(scene.bars))}};
}

std::vector<Column> series_of(const std::vector<l_box::Sample>& s, bool thixotropic) {
  using Sample = l_box::Sample;
  std::vector<Column> columns{
      column("time_s", s, [](const Sample& x) { return x.time; }),
      column("front_mm", s, [](const Sample& x) { return x.front * mm; }),
      column("h1_mm", s, [](const Sample& x) { return x.h1 * mm; }),
      column("h2_mm", s, [](const Sample& x) { return or_nan(x.h2) * mm; }),
      column("max_speed_m_per_s", s, [](const Sample& x) { return x.max_speed; }),
      column("shear_rate_mean_per_s", s, [](const Sample& x) { return x.shear_rate_mean; })};
  if (thixotropic)
    columns.push_back(
        column("flocculation_mean", s, [](const Sample& x) { return or_nan(x.flocculation_mean); }));
  columns.push_back(column("volume_change", s, [](const Sample& x) { return x.volume_change; }));
  columns.push_back(column("time_step_s", s, [](const Sample& x) { return x.time_step; }));
  columns.push_back(
      column("iterations", s, [](const Sample& x) { return static_cast<double>(x.iterations); }));
  return columns;
}

ResultTable profile_of(const l_box::Results& r) {
  using Place = std::array<double, 2>;
  return {"profile.csv",
          {column("distance_mm", r.profile, [](const Place& p) { return p[0] * mm; }),
           column("depth_mm", r.profile, [](const Place& p) { return p[1] * mm; })}};
}

std::vector<Chart> charts_of(bool thixotropic) {
  std::vector<Chart> charts{
      {"front.svg", "Front", time_label, "distance from the gate (mm)", {"front_mm"}, {}},
      {"depths.svg",
       "Depths",
       time_label,
       "depth (mm)",
       {"h1_mm", "h2_mm"},
       {},
       {"H1, behind the gate", "H2, at the channel's end"}},
      {"profile.svg",
       "Profile at the end",
       "distance from the gate (mm)",
       "depth (mm)",
       {"depth_mm"},
       {},
       {},
       "profile.csv"}};
  if (thixotropic)
    charts.push_back({"flocculation.svg",
                      "Flocculation",
                      time_label,
                      "mean flocculation state λ",
                      {"flocculation_mean"},
                      {}});
  return charts;
}

std::string ratio_text(const l_box::Scene& scene, const l_box::Results& r, Status status) {
  if (ended_early(status))
    return r.passing_ratio ? fmt::format("passing ratio   {:.2f} so far: no result", *r.passing_ratio)
                           : "passing ratio   none yet";
  if (!r.passing_ratio) return "passing ratio   none";
  const std::string cls = class_of(scene, r);
  const char* without = scene.bars == 0 ? "without bars the test has none"
                        : !r.stopped_at ? "not yet: it still moves"
                                        : "none: below 0.80";
  return fmt::format("passing ratio   {:.2f}   class {}", *r.passing_ratio, cls.empty() ? without : cls);
}

/// What to say of a place that the concrete has not come to.
const char* not_reached(Status status) { return ended_early(status) ? "not reached yet" : "never reached"; }

std::vector<std::string> lines_for(const l_box::Scene& scene, const l_box::Results& r, Status status) {
  const std::string h2 = r.h2 ? fmt::format("{:.0f} mm   at the channel's end", *r.h2 * mm)
                              : fmt::format("none: the channel's end was {}", not_reached(status));
  std::vector<std::string> lines{
      fmt::format("H1              {:.0f} mm   behind the gate", r.h1 * mm),
      "H2              " + h2,
      ratio_text(scene, r, status) + (r.passing_ratio && scene.model.space == SpaceKind::plane
                                          ? "; too large without side walls (model.space)"
                                          : ""),
      fmt::format("t200            {}", seconds_or(r.t200, not_reached(status))),
      fmt::format("t400            {}", seconds_or(r.t400, not_reached(status))),
      stopped_line(r.stopped_at, status),
      fmt::format("in the channel  {:.2f} l", r.volume_in_channel * 1e3)};
  add_flocculation_line(r.flocculation_mean_start, r.flocculation_mean_end, lines);
  return lines;
}

std::string no_class(const l_box::Scene& scene, const l_box::Results& r) {
  if (scene.bars == 0) return "none: without bars the test has no class";
  if (!r.stopped_at) return "none yet: it still moved";
  return r.passing_ratio ? "none: the passing ratio is below 0.80" : "none: there is no passing ratio";
}

std::vector<std::pair<std::string, std::string>> words_for_none(const l_box::Scene& scene,
                                                                const l_box::Results& r, Status status) {
  const std::string end = fmt::format("none: the channel's end was {}", not_reached(status));
  return {{"h2_mm", end},
          {"passing_ratio", end},
          {"t200_s", not_reached(status)},
          {"t400_s", not_reached(status)},
          {"class_en12350_10", no_class(scene, r)},
          {"stopped_at_s", still_moving(status)}};
}

/// The box seen from the side: column, channel, and the gate that rises.
Stage stage_of(const l_box::Scene& scene) {
  const l_box::Box& box = scene.box;
  const double end = box.column_length + box.channel_length;
  const bool plane =
      scene.model.space == SpaceKind::plane || scene.model.space == SpaceKind::plane_with_side_walls;
  Stage stage;
  stage.up = plane ? 1 : 2, stage.depth = plane ? 2 : 1;
  // Without the films on the side walls, which would fill the picture of the column.
  if (scene.model.space == SpaceKind::half) stage.slice = 0.25 * box.width;
  stage.walls = {{{0.0, box.column_height}, {0.0, 0.0}, {end, 0.0}, {end, box.channel_height}},
                 {{box.column_length, box.column_height}, {box.column_length, box.channel_height}}};
  if (scene.gate_speed) {
    stage.lifted = {{{box.column_length, 0.0}, {box.column_length, box.channel_height}}};
    stage.lift_speed = *scene.gate_speed;
  }
  stage.point_size = scene.model.cell[1] / scene.model.points_per_cell[1];
  return stage;
}

std::string judged(const l_box::Scene& scene, const l_box::Results& r) {
  if (!r.stopped_at || !r.passing_ratio) return {};
  const std::string cls = class_of(scene, r);
  if (!cls.empty()) return fmt::format("Class {} of EN 206: the passing ratio is at least 0.80.", cls);
  return scene.bars == 0
             ? "Without bars the test has no class; a passing ratio of 0.80 is what the classes ask for."
             : "No class: the passing ratio is below 0.80.";
}

l_box::Observer observe(const l_box::Scene& scene, bool all_frames, const Observer& observer) {
  l_box::Observer result;
  result.interrupted = observer.interrupted;
  result.checkpoints = observer.checkpoints;
  if (all_frames) result.on_frame = observer.on_frame;
  if (observer.on_progress) {
    result.on_step = [&scene, &observer](const l_box::Sample& s) {
      observer.on_progress(
          {s.time, scene.duration, s.time_step, fmt::format("front {:.0f} mm", s.front * mm)});
    };
  }
  return result;
}

}  // namespace

Outcome run_l_box(const l_box::Scene& scene, const Measured& measured, bool all_frames,
                  const Observer& observer) {
  l_box::Outcome raw = l_box::run(scene, observe(scene, all_frames, observer));
  if (!all_frames && observer.on_frame) observer.on_frame(raw.final_frame);
  const bool thixotropic = scene.mix.thixotropy.has_value();
  Outcome outcome;
  outcome.apparatus = "l_box";
  outcome.status = raw.status;
  outcome.results = results_of(scene, raw.results);
  outcome.checks = std::move(raw.checks);
  outcome.cost = raw.cost;
  outcome.series = series_of(raw.series, thixotropic);
  outcome.asked = asked_text(measured.name, "L-box", rest_told(scene));
  if (raw.results.passing_ratio) outcome.answers.push_back({"passing_ratio", "passing ratio", "", 2});
  outcome.answers.push_back({"h1_mm", "H1", "mm", 0});
  outcome.moving_at_end = !raw.results.stopped_at;
  outcome.judged = judged(scene, raw.results);
  outcome.none = words_for_none(scene, raw.results, raw.status);
  if (!raw.results.passing_ratio && !ended_early(raw.status))
    outcome.remarks.push_back("The concrete did not reach the channel's end: there is no passing ratio.");
  if (scene.model.space == SpaceKind::plane)
    outcome.remarks.push_back(
        "The box's side walls are left out, which makes the passing ratio too large: 0.75 for 0.60 at 50 Pa, "
        "0.64 for 0.43 at 75 Pa. model.space = \"plane_with_side_walls\" averages their drag.");
  outcome.stage = stage_of(scene);
  outcome.tables = {profile_of(raw.results)};
  outcome.charts = charts_of(thixotropic);
  outcome.lines = lines_for(scene, raw.results, raw.status);
  outcome.pictured = false;
  if (!std::isfinite(raw.results.h1)) outcome.checks.reasons.push_back("H1 is not a finite number");
  return outcome;
}

std::vector<std::string> l_box_uses(const l_box::Scene& scene) {
  const SpaceKind space = scene.model.space;
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(scene.gate_speed ? "gate: a moving wall along which the concrete slips"
                                   : "gate: left out (test.gate_speed = \"instant\")");
  lines.push_back(scene.bars > 0 ? fmt::format("bars: {} of 12 mm in front of the gate", scene.bars)
                                 : "bars: left out (test.bars = 0)");
  lines.push_back(space == SpaceKind::plane ? "side walls: left out (model.space = \"plane\")"
                  : space == SpaceKind::plane_with_side_walls
                      ? "side walls: their drag, averaged over the width"
                      : "side walls: no slip");
  const bool plane = space == SpaceKind::plane || space == SpaceKind::plane_with_side_walls;
  lines.push_back(plane ? "third dimension: left out (model.space)" : "third dimension: computed");
  add_model_uses(scene.model, lines);
  return lines;
}

}  // namespace tremie::scene
