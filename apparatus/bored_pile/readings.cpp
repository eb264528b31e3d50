#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/bored_pile/bored_pile.hpp"
#include "apparatus/common/flow_readings.hpp"
#include "apparatus/run/run_checks.hpp"

namespace tremie::bored_pile {

using namespace scene;

namespace {

using View = RunView<Scene, Record>;

constexpr double minutes = 1.0 / 60.0;

std::string no_head(const View&) { return "none: no head pushes this concrete through the pipe"; }

ResultValue cover_of(const View& v) {
  std::vector<Result> shares;
  for (std::size_t i = 0; i < v.r.cover.size(); ++i)
    shares.push_back({fmt::format("load_{}", i + 1), number(v.r.cover[i])});
  return shares;
}

Rows<View> level_rows() {
  using V = const View&;
  using S = const Sample&;
  return {
      {.name = "level_end_m",
       .words = "level of the concrete at the end, over the pile's base",
       .value = [](V v) { return number(v.r.level_end); },
       .label = "level",
       .digits = 2,
       .answer = [](V) { return std::optional<std::string>("level"); },
       .headline = 3,
       .headline_digits = 2},
      {"level_m", "mean level that the placed volume makes", {}, [](V, S s) { return s.level; }},
      {"level_at_pipe_m", "level at the pipe", {}, [](V, S s) { return s.level_pipe; }},
      {"level_between_m", "level midway between pipe and wall", {}, [](V, S s) { return s.level_middle; }},
      {"level_at_wall_m", "level at the pile's wall", {}, [](V, S s) { return s.level_wall; }},
      {.name = "level_step_mm",
       .words = "level inside the cage less that outside it, mean while concrete is placed",
       .value = [](V v) { return number(v.r.level_step, 1000.0); },
       .at = [](V, S s) { return s.level_step ? 1000.0 * *s.level_step : or_nan(s.level_step); },
       .label = "level step",
       .remark = [](V) { return std::string("   inside the cage less outside"); },
       .applies = [](V v) { return v.scene.cage.has_value(); }},
      {"mouth_m", "height of the pipe's mouth", {}, [](V, S s) { return s.mouth; }},
      {.name = "placed_m3",
       .words = "volume placed",
       .value = [](V v) { return number(v.r.placed); },
       .at = [](V, S s) { return s.volume; }},
      {"volume_error", "volume under the surface over the volume placed, less 1",
       [](V v) { return number(v.r.volume_error); }}};
}

Rows<View> head_rows() {
  using V = const View&;
  using S = const Sample&;
  return {
      {.name = "head_needed_m",
       .words = "largest height of concrete in the pipe above its mouth that the flow needs",
       .value = [](V v) { return number(v.r.head_needed); },
       .at = [](V, S s) { return or_nan(s.head); },
       .label = "head needed",
       .digits = 1,
       .none = no_head,
       .headline = 2,
       .headline_digits = 1},
      {"head_suffices", "whether the pipe's top stands that high all the time",
       [](V v) -> ResultValue { return v.r.head_suffices; }},
      {"pressure_at_mouth_Pa", "pressure at the pipe's mouth", {}, [](V, S s) { return s.pressure_mouth; }}};
}

Rows<View> concrete_rows() {
  using V = const View&;
  using S = const Sample&;
  return {{.name = "plug_share",
           .words = "share of the first load in the top metre at the end",
           .value = [](V v) { return number(v.r.plug_share); },
           .label = "plug share",
           .digits = 2,
           .answer = [](V) { return std::optional<std::string>("plug share"); },
           .headline = 1,
           .headline_digits = 2},
          {"cover", "share of each load in the cover: outside the cage, or the outer 75 mm", cover_of},
          {.name = "static_yield_stress_surface_Pa",
           .words = "largest static yield stress at the surface at the end",
           .value = [](V v) { return number(v.series.back().surface_stress); },
           .at = [](V, S s) { return s.surface_stress; },
           .label = "yield stress",
           .remark = [](V) { return std::string("   static, largest at the surface"); }},
          {"age_surface_oldest_min", "age of the oldest concrete at the surface at the end",
           [](V v) { return number(v.r.oldest_at_surface, minutes); }},
          {.name = "wall_pressure_max_Pa",
           .words = "largest pressure on the pile's wall",
           .value = [](V v) { return number(v.r.pressure_max); },
           .label = "wall pressure"},
          {"load", "number of the load that is placed", {}, [](V, S s) { return s.load; }}};
}

const std::vector<Reading<View>>& readings() {
  static const auto table = table_of<View>(time_column<View>(), concrete_rows(), head_rows(), level_rows(),
                                           motion_columns<View>(), step_columns<View>());
  return table;
}

const TableOf<AtWall> wall{
    "wall.csv",
    {{"height_m", "height over the pile's base", [](const AtWall& w) { return w.height; }},
     {"pressure_end_Pa", "pressure on the wall at the end", [](const AtWall& w) { return w.pressure_end; }},
     {"pressure_max_Pa", "largest pressure on the wall", [](const AtWall& w) { return w.pressure_max; }},
     {"pressure_hydrostatic_Pa", "pressure of concrete and fluid at rest",
      [](const AtWall& w) { return w.hydrostatic; }},
     {"flocculation_end", "flocculation state λ along the wall at the end",
      [](const AtWall& w) { return w.flocculation; }},
     {"age_end_min", "age of the concrete along the wall at the end",
      [](const AtWall& w) { return minutes * w.age; }}}};

std::string washed(const View& v) {
  if (!v.r.washed) return {};
  return "the pipe's mouth came to the concrete's surface: there the fluid washes it, which is not computed; "
         "a "
         "larger least "
         "pipe.embedment";
}

std::string crowded(const View& v) {
  constexpr double most = 0.01;
  if (std::abs(v.r.volume_error) <= most) return {};
  return fmt::format(
      "the points crowd: the volume under the surface is {:+.1f} % off what was placed, more than {:g} %: "
      "smaller cells",
      100.0 * v.r.volume_error, 100.0 * most);
}

std::string few_points(const View& v) { return experiment::one_point_a_cell(v.scene.model); }

std::string too_old(const View& v) {
  double oldest = v.r.oldest_at_surface;
  for (const Load& load : v.scene.loads) oldest = std::max(oldest, load.age + load.pause);
  if (oldest <= v.scene.workable) return {};
  return fmt::format(
      "concrete of {:.0f} min is placed, waits in the pipe or still moves at the surface; it is workable for "
      "{:.0f} min "
      "(test.workable): it sets, which is not computed",
      minutes * oldest, minutes * v.scene.workable);
}

std::vector<std::string> remarks_of(const View& v) {
  std::vector<std::string> remarks;
  if (v.r.stopped_at && !v.series.empty())
    remarks.push_back(fmt::format(
        "The pour stops at a level of {:.2f} m: at its full rate {}, and the pipe's top (pipe.above) "
        "gives {:.1f} m. A slower restart needs less.",
        *v.r.stopped_at,
        v.r.head_needed ? fmt::format("it needs a head of {:.1f} m above the mouth", *v.r.head_needed)
                        : "no head pushes it",
        v.scene.depth + v.scene.pipe.above - v.series.back().mouth));
  double volume = 0.0;
  for (const Load& load : v.scene.loads) volume += load.volume;
  if (v.r.placed < 0.999 * volume && !v.r.stopped_at && !ended_early(v.status))
    remarks.push_back(fmt::format("The pile is full: {:.2f} of {:.2f} m³ were placed.", v.r.placed, volume));
  if (v.scene.width > 0.0)
    remarks.push_back(
        "A panel as a plane: the pipe is a slot across its width" +
        std::string(v.scene.model.space == SpaceKind::plane ? ", and its long walls are left out." : "."));
  remarks.push_back("No stones, no bleeding, no mixing with the fluid; not validated by a pour.");
  return remarks;
}

Stage stage_of(const Scene& scene) {
  Stage stage;
  stage.mirrored = true;
  if (scene.width > 0.0) stage.up = 1, stage.depth = 2;
  stage.walls = {{{scene.radius, scene.depth}, {scene.radius, 0.0}, {0.0, 0.0}}};
  stage.point_size = scene.model.cell[1] / scene.model.points_per_cell[1];
  return stage;
}

scene::Outcome run_and_read(const Scene& scene, const RunOptions& options, const Observer& observer) {
  const Record raw = run(scene, observer);
  const View view{scene, raw};
  scene::Outcome outcome = outcome_of(readings(), view, options.measured.name, "bored pile");
  add_reasons<View>({washed, crowded, few_points, too_old}, view, outcome.checks.reasons);
  outcome.remarks = remarks_of(view);
  outcome.stage = stage_of(scene);
  outcome.axisymmetric = scene.width == 0.0;
  outcome.pictured = false;
  outcome.tables = {table_from(wall, raw.results.wall)};
  outcome.charts = {
      {"level.svg",
       "Level",
       "time (s)",
       "over the base (m)",
       {"level_at_pipe_m", "level_at_wall_m", "mouth_m"},
       {},
       {"at the pipe", "at the wall", "pipe's mouth"}},
      {"head.svg", "Head needed in the pipe", "time (s)", "above its mouth (m)", {"head_needed_m"}},
      {"wall.svg",
       "Pressure on the wall",
       "height (m)",
       "pressure (Pa)",
       {"pressure_end_Pa", "pressure_hydrostatic_Pa"},
       {},
       {"at the end", "at rest"},
       "wall.csv"}};
  return outcome;
}

std::vector<std::string> uses(const Scene& scene) {
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  if (scene.width > 0.0)
    lines.push_back(scene.model.space == SpaceKind::plane
                        ? "long walls: left out (model.space = \"plane\")"
                        : "long walls: their drag, averaged over the width");
  lines.push_back("pipe: its inside by its head alone, its outside a wall that holds");
  lines.push_back(fmt::format("loads: {} of {}, told apart point by point", scene.loads.size(),
                              scene.mixes.empty() ? "one mix" : "their own mixes"));
  lines.push_back("fluid: by its buoyancy and its pressure; no mixing");
  lines.push_back("walls: " + word(scene.walls));
  lines.push_back(scene.cage
                      ? "reinforcement: a screen with the drag of its bars and hoops, smeared around the pile"
                      : "reinforcement: left out (no [cage])");
  add_model_uses(scene.model, lines);
  return lines;
}

}  // namespace

Apparatus apparatus() {
  return make_apparatus<Scene>(apparatus_of(keys(), "bored pile", readings(), wall), read_scene, uses,
                               run_and_read, estimate);
}

}  // namespace tremie::bored_pile
