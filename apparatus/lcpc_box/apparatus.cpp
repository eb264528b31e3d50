// The LCPC box: concrete poured slowly at one end of a long box, and how far it spreads.

#include <fmt/format.h>

#include <algorithm>

#include "apparatus/common/flow_readings.hpp"
#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/parts/boxes/boxes.hpp"

namespace tremie::lcpc_box {

using namespace scene;

namespace {

using View = RunView<boxes::Scene, boxes::Outcome>;

Section box_section() {
  return {.name = "box",
          .help =
              "Inner dimensions; the defaults are those of reference_data/boxes/lcpc_box.toml. Or box = "
              "\"lcpc_box\", a name from that folder, or a path to a .toml file.",
          .keys = {{.name = "length", .range = positive, .fallback = "1200 mm"},
                   {.name = "width", .range = positive, .fallback = "200 mm"},
                   {.name = "height", .range = positive, .fallback = "150 mm"},
                   {.name = "name", .kind = Kind::text, .help = "what people call it"},
                   {.name = "standard", .kind = Kind::text, .help = "that describes it"}}};
}

Section test_section() {
  return {.name = "test",
          .help = "The schedule.",
          .keys = {{.name = "volume", .dimension = Dimension::volume, .range = positive, .fallback = "6 l"},
                   rest_key("0 s", "in the bucket"),
                   {.name = "pour_time",
                    .dimension = Dimension::time,
                    .range = positive,
                    .fallback = "30 s",
                    .help = "to empty the bucket"},
                   {.name = "pour_to",
                    .range = {.low = 0.05},
                    .fallback = "100 mm",
                    .help = "it lands between 20 mm and this from the end wall"},
                   {.name = "fall",
                    .range = not_negative,
                    .fallback = "0 mm",
                    .help = "from the bucket's lip to the floor; 0 mm: laid down at rest"},
                   duration_key("300 s")}};
}

void settle(Values& values) {
  settle_mix(values);
  settle_interface(values, "walls");
  const double length = values.number("box.length"), width = values.number("box.width");
  const auto at_most = [&](const char* key, double most, Dimension dimension, const char* what) {
    if (values.number(key) > most)
      values.fail(
          key, fmt::format("is more than {}; allowed: at most \"{}\"", what, write_at_most(most, dimension)));
  };
  at_most("test.volume", length * width * values.number("box.height"), Dimension::volume, "the box holds");
  at_most("test.pour_to", 0.5 * length, Dimension::length, "half of the box");
  at_most("test.pour_time", values.number("test.duration"), Dimension::time, "test.duration");
}

ApparatusKeys keys() {
  const Section walls{
      .name = "walls", .help = "Of the floor, the ends and the side walls.", .keys = contact_keys(false)};
  const Section model = model_section({"plane_with_side_walls", "plane"},
                                      {.cell = "[\"10 mm\", \"5 mm\"]",
                                       .points_per_cell = "[8, 4]",
                                       .cell_help = "[across, up], or one length",
                                       .points_help = "[across, up], or one number for each direction",
                                       .space_help = "no three dimensions: the pour is laid on a section"});
  return {.name = "lcpc_box",
          .help = "The LCPC box (Roussel 2007).",
          .schema = joined(
              {mix_sections("5 MPa"), {box_section(), test_section(), walls, model, output_section()}}),
          .settle = settle};
}

boxes::Scene read_scene(const Values& values) {
  boxes::Scene scene;
  scene.mix = read_mix(values);
  scene.model = read_model(values);
  scene.pour =
      boxes::Pour{values.number("test.volume"), values.number("test.pour_time"), values.number("test.fall")};
  const double landing = values.number("test.pour_to"), width = values.number("box.width");
  scene.box = {.column_length = landing,
               .column_height = std::min(2.0 * scene.model.cell[1], scene.pour->volume / (width * landing)),
               .channel_length = values.number("box.length") - landing,
               .channel_height = values.number("box.height"),
               .width = width};
  scene.rest = values.number("test.rest");
  scene.duration = values.number("test.duration");
  scene.gate_speed = std::nullopt;
  scene.walls = read_wall_law(values, "walls");
  scene.frame_interval = read_output(values).frame_interval;
  boxes::check_cells(values, scene);
  check_points(values, scene.pour->volume / width / (scene.model.cell[0] * scene.model.cell[1]) *
                           scene.model.points_per_cell[0] * scene.model.points_per_cell[1]);
  return scene;
}

/// Of the concrete, from the end wall where it was poured [m].
double length_of(const View& v, const boxes::Sample& s) { return v.scene.box.column_length + s.front; }

bool reached_the_end(const View& v) { return v.r.h2.has_value(); }

Rows<View> length_rows() {
  using V = const View&;
  using S = const boxes::Sample&;
  return {{.name = "length_mm",
           .words = "spread length, from the end wall",
           .value =
               [](V v) {
                 return number(
                     reached_the_end(v) ? std::nullopt : std::optional(length_of(v, v.series.back())), mm);
               },
           .at = [](V v, S s) { return length_of(v, s) * mm; },
           .label = "spread length",
           .none =
               [](V v) {
                 return std::string(reached_the_end(v) ? "none: the concrete reached the other end" : "");
               },
           .answer = [](V) { return std::optional<std::string>("spread length"); },
           .headline = 1,
           .measurable = true},
          {.name = "thickness_mm",
           .words = "thickness at the end where it was poured",
           .value = [](V v) { return number(v.r.h1, mm); },
           .at = [](V, S s) { return s.h1 * mm; },
           .label = "thickness",
           .headline = 2,
           .measurable = true}};
}

const std::vector<Reading<View>>& readings() {
  static const auto table =
      table_of<View>(time_column<View>(), length_rows(), stopped_row<View>(), flocculation_rows<View>(),
                     motion_columns<View>(), step_columns<View>());
  return table;
}

std::string over_the_top(const View& v) {
  double most = 0.0;
  for (const boxes::Sample& s : v.series) most = std::max(most, s.h1);
  if (most <= v.scene.box.channel_height) return {};
  return fmt::format(
      "the concrete stood {:.0f} mm high where it was poured, above the box of {:.0f} mm: pour more slowly, "
      "or less",
      mm * most, mm * v.scene.box.channel_height);
}

Stage stage_of(const boxes::Scene& scene) {
  const double end = scene.box.column_length + scene.box.channel_length, top = scene.box.channel_height;
  Stage stage;
  stage.up = 1, stage.depth = 2;
  stage.walls = {{{0.0, top}, {0.0, 0.0}, {end, 0.0}, {end, top}}};
  stage.point_size = scene.model.cell[1] / scene.model.points_per_cell[1];
  return stage;
}

Outcome run_and_read(const boxes::Scene& scene, const RunOptions& options, const Observer& observer) {
  const boxes::Outcome raw = boxes::run(scene, observer, [](const boxes::Sample& now) {
    return fmt::format("front {:.0f} mm beyond where it lands", mm * now.front);
  });
  const View view{scene, raw};
  Outcome outcome = outcome_of(readings(), view, options.measured.name, "LCPC box");
  add_reasons<View>({over_the_top}, view, outcome.checks.reasons);
  outcome.moving_at_end = !raw.results.stopped_at;
  outcome.stage = stage_of(scene);
  const char* time = "time since the start of the pour (s)";
  outcome.charts = {
      {"length.svg", "Spread length", time, "length (mm)", {"length_mm"}},
      {"thickness.svg", "Thickness where it was poured", time, "thickness (mm)", {"thickness_mm"}}};
  outcome.pictured = false;
  return outcome;
}

std::vector<std::string> uses(const boxes::Scene& scene) {
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(scene.pour->fall > 0.0 ? "bucket: its concrete comes onto the surface as fast as it fell"
                                         : "bucket: its concrete is laid on the surface, at rest");
  lines.push_back(scene.model.space == SpaceKind::plane ? "side walls: left out (model.space = \"plane\")"
                                                        : "side walls: their drag, averaged over the width");
  lines.push_back("walls: " + word(scene.walls));
  add_model_uses(scene.model, lines);
  return lines;
}

}  // namespace

Apparatus apparatus() {
  return make_apparatus<boxes::Scene>(apparatus_of(keys(), "LCPC box", readings()), read_scene, uses,
                                      run_and_read, boxes::estimate);
}

}  // namespace tremie::lcpc_box
