// The U-box: concrete in one of two compartments flows under the wall between them when the gate there is lifted, and rises in
// the other one.

#include <fmt/format.h>

#include "apparatus/common/flow_readings.hpp"
#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/parts/boxes/boxes.hpp"

namespace tremie::u_box {

using namespace scene;

namespace {

using View = RunView<boxes::Scene, boxes::Outcome>;

constexpr double bar_diameter = 0.013;  ///< [m]

Section box_section() {
  return {
      .name = "box",
      .help =
          "Inner dimensions; the defaults are those of reference_data/boxes/u_box.toml. Or box = "
          "\"u_box\", a name from that folder, or a path to a .toml file.",
      .keys = {{.name = "compartment",
                .range = {.low = 0.05},
                .fallback = "140 mm",
                .help = "length of each of the two, along the flow"},
               {.name = "height", .range = positive, .fallback = "680 mm", .help = "of the concrete too"},
               {.name = "opening", .range = positive, .fallback = "190 mm", .help = "height of the gate"},
               {.name = "width", .range = positive, .fallback = "200 mm", .help = "between the side walls"},
               {.name = "name", .kind = Kind::text, .help = "what people call it"},
               {.name = "standard", .kind = Kind::text, .help = "that describes it"}}};
}

Section test_section() {
  return {.name = "test",
          .help = "The schedule.",
          .keys = {rest_key("60 s", "in the compartment, before the gate is lifted"),
                   duration_key("180 s"),
                   lift_key("gate_speed", "30 cm/s", "of the lift"),
                   {.name = "bars",
                    .kind = Kind::integer,
                    .range = between(0, 3),
                    .fallback = "0",
                    .help = "0, or 3 of 13 mm in the opening, by their drag averaged over the width"}}};
}

void check_bars(const Values& values) {
  const auto bars = values.integer("test.bars");
  if (bars == 0) return;
  if (bars != 3) values.fail("test.bars", fmt::format("{} is not allowed; allowed: 0 or 3", bars));
  if (values.word("model.method") == "newton")
    values.fail("model.method",
                "\"newton\" does not know bars; allowed with test.bars: \"auto\" or \"admm\"");
  boxes::check_width(values, 3, bar_diameter);
}

void settle(Values& values) {
  settle_mix(values);
  settle_interface(values, "walls");
  check_bars(values);
  if (values.number("box.opening") > values.number("box.height"))
    values.fail("box.opening", fmt::format("is above the box's top; allowed: at most height, \"{}\"",
                                           write_quantity(values.number("box.height"), Dimension::length)));
}

ApparatusKeys keys() {
  const Section walls{.name = "walls",
                      .help =
                          "Contact of the floor, ends, side walls and the wall between the compartments. "
                          "With \"no_slip\" the gate itself is frictionless.",
                      .keys = contact_keys(false)};
  const Section model = model_section({"plane_with_side_walls", "plane"},
                                      {.cell = "10 mm",
                                       .points_per_cell = "8",
                                       .cell_help = "[across, up], or one length",
                                       .points_help = "[across, up], or one number for each direction"});
  return {.name = "u_box",
          .help = "The U-box test of JSCE-F 511 and EFNARC.",
          .schema = joined(
              {mix_sections("5 MPa"), {box_section(), test_section(), walls, model, output_section()}}),
          .settle = settle};
}

boxes::Scene read_scene(const Values& values) {
  boxes::Scene scene;
  const double compartment = values.number("box.compartment");
  scene.mix = read_mix(values);
  scene.box = {.column_length = compartment,
               .column_height = values.number("box.height"),
               .channel_length = compartment,
               .channel_height = values.number("box.opening"),
               .width = values.number("box.width"),
               .bar_diameter = bar_diameter};
  scene.rest = values.number("test.rest");
  scene.duration = values.number("test.duration");
  scene.gate_speed = values.number_unless("test.gate_speed", "instant");
  scene.bars = static_cast<int>(values.integer("test.bars"));
  scene.walls = read_wall_law(values, "walls");
  scene.model = read_model(values);
  scene.frame_interval = read_output(values).frame_interval;
  boxes::check_cells(values, scene);
  return scene;
}

std::optional<double> difference(const View& v) {
  if (!v.r.h2) return std::nullopt;
  return v.r.h1 - *v.r.h2;
}

std::string far_wall_not_reached(const View& v) { return "none: the far wall was " + not_reached(v); }

Rows<View> height_rows() {
  using V = const View&;
  using S = const boxes::Sample&;
  return {{.name = "rise_mm",
           .words = "filling height, of the concrete beyond the gate",
           .value = [](V v) { return number(v.r.h2, mm); },
           .at = [](V, S s) { return or_nan(s.h2) * mm; },
           .label = "filling height",
           .none = far_wall_not_reached,
           .answer = [](V) { return std::optional<std::string>("filling height"); },
           .headline = 1,
           .measurable = true},
          {.name = "height_difference_mm",
           .words = "height behind the gate less that beyond it",
           .value = [](V v) { return number(difference(v), mm); },
           .label = "difference",
           .none = far_wall_not_reached,
           .headline = 2,
           .measurable = true},
          {.name = "h1_mm",
           .words = "height of the concrete behind the gate",
           .value = [](V v) { return number(v.r.h1, mm); },
           .at = [](V, S s) { return s.h1 * mm; },
           .label = "behind the gate"}};
}

const std::vector<Reading<View>>& readings() {
  static const auto table =
      table_of<View>(time_column<View>(), height_rows(), stopped_row<View>(), flocculation_rows<View>(),
                     motion_columns<View>(), step_columns<View>());
  return table;
}

/// The box seen from the side: the two compartments, and the gate that rises.
Stage stage_of(const boxes::Scene& scene) {
  const boxes::Box& box = scene.box;
  const double middle = box.column_length, end = middle + box.channel_length;
  Stage stage;
  stage.up = 1, stage.depth = 2;
  stage.walls = {{{0.0, box.column_height}, {0.0, 0.0}, {end, 0.0}, {end, box.column_height}},
                 {{middle, box.column_height}, {middle, box.channel_height}}};
  if (scene.gate_speed) {
    stage.lifted = {{{middle, 0.0}, {middle, box.channel_height}}};
    stage.lift_speed = *scene.gate_speed;
  }
  stage.point_size = scene.model.cell[1] / scene.model.points_per_cell[1];
  return stage;
}

std::string judged(const View& v) {
  constexpr double asked_for = 0.3;
  if (!v.r.stopped_at || !v.r.h2) return {};
  return fmt::format("The filling height is {} 300 mm that are asked of self-compacting concrete{}.",
                     *v.r.h2 >= asked_for ? "at least the" : "below the",
                     v.scene.bars > 0 ? "" : ", here without bars");
}

/// Measured: seven cells make the filling height 0.6 % too large, five 3 %, four 4 %, against fourteen and twenty-eight.
std::string few_cells_across(const View& v) {
  constexpr double least = 7.0;
  const double cells = v.scene.box.column_length / v.scene.model.cell[0];
  if (cells > least - 0.1) return {};
  return fmt::format(
      "a compartment is {:.2g} cells long, fewer than {:g}: the filling height may be off by more than 2 %; "
      "use a smaller model.cell",
      cells, least);
}

Outcome run_and_read(const boxes::Scene& scene, const RunOptions& options, const Observer& observer) {
  const boxes::Outcome raw = boxes::run(scene, observer, [](const boxes::Sample& now) {
    return fmt::format("behind the gate {:.0f} mm, beyond it {:.0f} mm", mm * now.h1,
                       mm * now.h2.value_or(0.0));
  });
  const View view{scene, raw};
  Outcome outcome = outcome_of(readings(), view, options.measured.name, "U-box");
  add_reasons<View>({few_cells_across}, view, outcome.checks.reasons);
  outcome.moving_at_end = !raw.results.stopped_at;
  outcome.judged = judged(view);
  outcome.stage = stage_of(scene);
  outcome.charts = {{"heights.svg",
                     "Heights",
                     "time since the start of the lift (s)",
                     "height (mm)",
                     {"h1_mm", "rise_mm"},
                     {},
                     {"behind the gate", "beyond it"}}};
  outcome.pictured = false;
  return outcome;
}

std::vector<std::string> uses(const boxes::Scene& scene) {
  std::vector<std::string> lines{flocculation_use(scene.mix)};
  lines.push_back(scene.gate_speed ? "gate: a moving wall along which the concrete slips"
                                   : "gate: left out (test.gate_speed = \"instant\")");
  lines.push_back(scene.model.space == SpaceKind::plane ? "side walls: left out (model.space = \"plane\")"
                                                        : "side walls: their drag, averaged over the width");
  lines.push_back("walls: " + word(scene.walls));
  lines.push_back(scene.bars > 0 ? fmt::format("bars: {} of 13 mm, averaged over the width", scene.bars)
                                 : "bars: left out (test.bars = 0)");
  add_model_uses(scene.model, lines);
  return lines;
}

}  // namespace

Apparatus apparatus() {
  return make_apparatus<boxes::Scene>(apparatus_of(keys(), "U-box", readings()), read_scene, uses,
                                      run_and_read, boxes::estimate);
}

}  // namespace tremie::u_box
