#include <fmt/format.h>

#include <cmath>

#include "apparatus/common/flow_readings.hpp"
#include "apparatus/l_box/l_box.hpp"

namespace tremie::l_box {

using namespace scene;

namespace {

constexpr const char* time_label = "time since the start of the lift (s)";

std::string class_of(const Scene& scene, const Results& r) {
  if (!r.stopped_at) return "";  // a class is that of concrete at rest
  return r.passing_ratio ? passing_class(*r.passing_ratio, scene.bars) : "";
}

using View = RunView<Scene, Outcome>;

std::vector<Chart> charts_of(bool thixotropic) {
  std::vector<Chart> charts{{"front.svg", "Front", time_label, "distance from the gate (mm)", {"front_mm"}},
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
    charts.push_back(
        {"flocculation.svg", "Flocculation", time_label, "mean flocculation state λ", {"flocculation_mean"}});
  return charts;
}

std::string ratio_text(const Scene& scene, const Results& r, Status status) {
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

std::string no_class(const Scene& scene, const Results& r) {
  if (scene.bars == 0) return "none: without bars the test has no class";
  if (!r.stopped_at) return "none yet: it still moved";
  return r.passing_ratio ? "none: the passing ratio is below 0.80" : "none: there is no passing ratio";
}

std::string end_not_reached(const View& v) { return "none: the channel's end was " + not_reached(v); }

std::string ratio_line(const View& v) {
  const bool too_large = v.r.passing_ratio && v.scene.model.space == SpaceKind::plane;
  return ratio_text(v.scene, v.r, v.status) +
         (too_large ? "; too large without side walls (model.space)" : "");
}

Reading<View> time_row(const char* name, const char* words, const char* label,
                       ResultValue (*time)(const View&)) {
  return {.name = name,
          .words = words,
          .value = time,
          .label = label,
          .digits = 2,
          .none = not_reached<View>,
          .measurable = true};
}

Rows<View> depth_rows() {
  using V = const View&;
  using S = const Sample&;
  return {{"front_mm", "distance of the front from the gate", {}, [](V, S s) { return s.front * mm; }},
          {.name = "h1_mm",
           .words = "H1, depth behind the gate",
           .value = [](V v) { return number(v.r.h1, mm); },
           .at = [](V, S s) { return s.h1 * mm; },
           .label = "H1",
           .remark = [](V) { return std::string("   behind the gate"); },
           .answer = [](V) { return std::optional<std::string>("H1"); },
           .headline = 2,
           .measurable = true},
          {.name = "h2_mm",
           .words = "H2, depth at the channel's end",
           .value = [](V v) { return number(v.r.h2, mm); },
           .at = [](V, S s) { return or_nan(s.h2) * mm; },
           .label = "H2",
           .none = end_not_reached,
           .remark = [](V v) { return std::string(v.r.h2 ? "   at the channel's end" : ""); },
           .headline = 3,
           .measurable = true}};
}

Rows<View> ratio_rows() {
  using V = const View&;
  Reading<View> t400 =
      time_row("t400_s", "t400, front 400 mm from the gate", "t400", [](V v) { return number(v.r.t400); });
  t400.headline = 4, t400.headline_digits = 2;
  return {
      {.name = "passing_ratio",
       .words = "passing ratio H2/H1",
       .value = [](V v) { return number(v.r.passing_ratio); },
       .label = "passing ratio",
       .digits = 2,
       .none = end_not_reached,
       .answer = [](V) { return std::optional<std::string>("passing ratio"); },
       .headline = 1,
       .headline_digits = 3,
       .measurable = true,
       .lines = [](V v) { return std::vector{ratio_line(v)}; }},
      {"passing_ratio_change_per_min", "change of the passing ratio over the last 30 s, a minute",
       [](V v) { return number(v.r.ratio_change, 60.0); }},
      time_row("t200_s", "t200, front 200 mm from the gate", "t200", [](V v) { return number(v.r.t200); }),
      t400,
      {.name = "class_en12350_10",
       .words = "passing-ability class (EN 206); of concrete at rest",
       .value = [](V v) { return word_or_null(class_of(v.scene, v.r)); },
       .none = [](V v) { return no_class(v.scene, v.r); }}};
}

const std::vector<Reading<View>>& readings() {
  using V = const View&;
  static const auto table = table_of<View>(
      time_column<View>(), depth_rows(), ratio_rows(), stopped_row<View>(), flocculation_rows<View>(),
      Rows<View>{{.name = "volume_in_channel_m3",
                  .words = "volume in the channel",
                  .value = [](V v) { return number(v.r.volume_in_channel); },
                  .lines =
                      [](V v) {
                        return std::vector{
                            fmt::format("in the channel  {:.2f} l", v.r.volume_in_channel * 1e3)};
                      }},
                 {"bars", "bars in front of the gate",
                  [](V v) { return number(static_cast<double>(v.scene.bars)); }}},
      motion_columns<View>(), step_columns<View>());
  return table;
}

using Place = std::array<double, 2>;
const TableOf<Place> profile{
    "profile.csv",
    {{"distance_mm", "distance from the gate", [](const Place& p) { return p[0] * mm; }},
     {"depth_mm", "", [](const Place& p) { return p[1] * mm; }}}};

/// The box seen from the side: column, channel, and the gate that rises.
Stage stage_of(const Scene& scene) {
  const Box& box = scene.box;
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

std::string judged(const Scene& scene, const Results& r) {
  if (!r.stopped_at || !r.passing_ratio) return {};
  const std::string cls = class_of(scene, r);
  if (!cls.empty()) return fmt::format("Class {} of EN 206: the passing ratio is at least 0.80.", cls);
  return scene.bars == 0
             ? "Without bars the test has no class; a passing ratio of 0.80 is what the classes ask for."
             : "No class: the passing ratio is below 0.80.";
}

scene::Outcome run_and_read(const Scene& scene, const RunOptions& options, const Observer& observer) {
  const Outcome raw = l_box::run(scene, observer);
  scene::Outcome outcome = outcome_of(readings(), View{scene, raw}, options.measured.name, "L-box");
  outcome.moving_at_end = !raw.results.stopped_at;
  outcome.judged = judged(scene, raw.results);
  if (!raw.results.passing_ratio && !ended_early(raw.status))
    outcome.remarks.push_back("The concrete did not reach the channel's end: there is no passing ratio.");
  if (scene.model.space == SpaceKind::plane)
    outcome.remarks.push_back(
        "The box's side walls are left out, which makes the passing ratio too large: 0.72 for 0.59 at 50 Pa, "
        "0.56 for 0.37 at 75 Pa. model.space = \"plane_with_side_walls\" averages their drag.");
  outcome.stage = stage_of(scene);
  outcome.tables = {table_from(profile, raw.results.profile)};
  outcome.charts = charts_of(scene.mix.thixotropy.has_value());
  outcome.pictured = false;
  return outcome;
}

std::vector<std::string> uses(const Scene& scene) {
  const SpaceKind space = scene.model.space;
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(scene.gate_speed ? "gate: a moving wall along which the concrete slips"
                                   : "gate: left out (test.gate_speed = \"instant\")");
  lines.push_back(scene.bars > 0 ? fmt::format("bars: {} of 12 mm in front of the gate", scene.bars)
                                 : "bars: left out (test.bars = 0)");
  lines.push_back(space == SpaceKind::plane ? "side walls: left out (model.space = \"plane\")"
                  : space == SpaceKind::plane_with_side_walls
                      ? "side walls: their drag, averaged over the width"
                      : "side walls: computed");
  lines.push_back("walls: " + word(scene.walls));
  const bool plane = space == SpaceKind::plane || space == SpaceKind::plane_with_side_walls;
  lines.push_back(plane ? "third dimension: left out (model.space)" : "third dimension: computed");
  add_model_uses(scene.model, lines);
  return lines;
}

}  // namespace

Apparatus apparatus() {
  return make_apparatus<Scene>(apparatus_of(keys(), "L-box", readings(), profile), read_scene, uses,
                               run_and_read, estimate);
}

}  // namespace tremie::l_box
