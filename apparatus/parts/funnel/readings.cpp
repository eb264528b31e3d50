#include <fmt/format.h>

#include <algorithm>

#include "apparatus/parts/funnel/funnel.hpp"

namespace tremie::funnel {

using namespace scene;

namespace {

constexpr const char* time_label = "time since the mouth opened (s)";

/// Why there is no flow time.
std::string no_flow_time(const View& v) {
  if (ended_early(v.status)) return "none yet: the run ended early";
  if (v.r.stopped_at)
    return fmt::format("none: the yield stress held the concrete in the funnel, {:.0f} % had left",
                       100.0 * v.r.emptied);
  return fmt::format("none: light was not seen within test.duration, {:.0f} % had left", 100.0 * v.r.emptied);
}

std::string why_not_stopped(const View& v) {
  return v.r.flow_time ? "none: the concrete flowed until light was seen" : still_moving(v.status);
}

std::vector<std::string> stopped_lines(const View& v) {
  if (v.r.flow_time) return {};
  return {stopped_line(v.r.stopped_at, v.status)};
}

}  // namespace

Rows<View> flow_rows() {
  using V = const View&;
  using S = const Sample&;
  return {{.name = "flow_time_s",
           .words = "flow time, until light is seen through the mouth",
           .value = [](V v) { return number(v.r.flow_time); },
           .label = "flow time",
           .digits = 1,
           .none = no_flow_time,
           .answer = [](V) { return std::optional(std::string("flow time")); },
           .headline = 1,
           .headline_digits = 2,
           .measurable = true},
          {.name = "emptied",
           .words = "share of the concrete that has left",
           .value = [](V v) { return number(v.r.emptied); },
           .at = [](V, S s) { return s.emptied; },
           .label = "emptied",
           .digits = 3}};
}

Rows<View> course_rows() {
  using V = const View&;
  using S = const Sample&;
  return table_of<View>(
      Rows<View>{
          {"discharge_m3_per_s",
           "discharge, over a tenth of a second",
           {},
           [](V, S s) { return s.discharge; }},
          {"height_mm", "height at the axis, over the mouth", {}, [](V, S s) { return s.height * mm; }}},
      Rows<View>{{.name = "stopped_at_s",
                  .words = "came to rest in the funnel at",
                  .value = [](V v) { return number(v.r.stopped_at); },
                  .none = why_not_stopped,
                  .lines = stopped_lines}},
      flocculation_rows<View>(),
      Rows<View>{
          {.name = "volume_m3",
           .words = "concrete in the funnel at the start",
           .value = [](V v) { return number(v.r.volume); },
           .lines =
               [](V v) { return std::vector{fmt::format("volume          {:.2f} l", 1e3 * v.r.volume)}; }},
          {"volume_error", "relative volume error: (discharged + remaining)/initial − 1",
           [](V v) { return number(v.r.volume_error); }}},
      motion_columns<View>(), step_columns<View>());
}

namespace {

std::vector<std::string> uses(const Scene& scene) {
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back("walls: " + word(scene.walls));
  lines.push_back("mouth: opens instantaneously; the concrete falls freely below it");
  if (scene.shape.depth > 0.0)
    lines.push_back(scene.model.space == SpaceKind::plane
                        ? "side walls: left out (model.space = \"plane\")"
                        : "side walls: their drag, averaged over the width");
  lines.push_back(scene.shape.depth > 0.0 ? "third dimension: left out (model.space)"
                                          : "third dimension: left out (model.space = \"axisymmetric\")");
  add_model_uses(scene.model, lines);
  return lines;
}

Stage stage_of(const Scene& scene) {
  Stage stage;
  if (scene.shape.depth > 0.0) stage.up = 1, stage.depth = 2;
  stage.mirrored = true;
  Outline wall;
  const std::vector<Part> parts = parts_of(scene.shape);
  wall.push_back({parts.front().half_low, 0.0});
  for (const Part& p : parts) wall.push_back({p.half_high, p.to});
  stage.walls = {wall};
  const auto [h, h_up] = scene.model.cell;
  const auto [n, n_up] = scene.model.points_per_cell;
  stage.point_size = std::max(h / n, h_up / n_up);
  return stage;
}

std::vector<Chart> charts_of(const Scene& scene) {
  std::vector<Chart> charts{
      {"emptied.svg", "Emptied", time_label, "share that has left", {"emptied"}},
      {"discharge.svg", "Discharge", time_label, "discharge (m³/s)", {"discharge_m3_per_s"}}};
  if (scene.mix.thixotropy)
    charts.push_back(
        {"flocculation.svg", "Flocculation", time_label, "mean flocculation state λ", {"flocculation_mean"}});
  return charts;
}

/// Remarks, charts and stage of an outcome whose table has been read.
void add_pages(const View& view, scene::Outcome& outcome) {
  const Scene& scene = view.scene;
  const Results& r = view.r;
  outcome.moving_at_end = !r.flow_time && !r.stopped_at;
  if (!r.flow_time && !ended_early(view.status))
    outcome.remarks.push_back("The funnel did not empty. Flow time " + no_flow_time(view) + ".");
  else if (r.flow_time)
    outcome.remarks.push_back(fmt::format(
        "When light was seen, {:.0f} % of the concrete had left; the rest is on the walls and falls later.",
        100.0 * r.emptied));
  if (scene.shape.depth > 0.0 && scene.model.space == SpaceKind::plane)
    outcome.remarks.push_back(
        "The funnel's side walls are left out, which makes the flow time too short. model.space = "
        "\"plane_with_side_walls\" averages their drag.");
  outcome.remarks.push_back(
      "The concrete is a fluid: no stone blocks the mouth and none settles. A blocked funnel takes longer "
      "than this.");
  outcome.axisymmetric = scene.shape.depth == 0.0;
  outcome.stage = stage_of(scene);
  outcome.charts = charts_of(scene);
  outcome.pictured = false;
}

}  // namespace

Apparatus apparatus_of(const FunnelTest& test, const std::vector<Reading<View>>& table,
                       void (*finish)(const View&, scene::Outcome&)) {
  const auto run_and_read = [&table, finish, words = std::string(test.words)](
                                const Scene& scene, const RunOptions& options, const Observer& observer) {
    const Outcome raw = run(scene, observer);
    const View view{scene, raw};
    scene::Outcome outcome = outcome_of(table, view, options.measured.name, words);
    add_pages(view, outcome);
    if (finish) finish(view, outcome);
    return outcome;
  };
  return make_apparatus<Scene>(scene::apparatus_of(keys(test), test.words, table), read_scene, uses,
                               run_and_read, estimate);
}

}  // namespace tremie::funnel
