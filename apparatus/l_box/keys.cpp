#include <fmt/format.h>

#include <algorithm>

#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/l_box/l_box.hpp"

namespace tremie::l_box {

using namespace scene;

namespace {

Section box_section() {
  return {
      .name = "box",
      .help = "Inner dimensions; the defaults are EN 12350-10's. The channel begins at the gate.",
      .keys = {{.name = "column_length", .range = positive, .fallback = "100 mm", .help = "along the flow"},
               {.name = "column_height", .range = positive, .fallback = "600 mm"},
               {.name = "channel_length", .range = positive, .fallback = "700 mm"},
               {.name = "channel_height", .range = positive, .fallback = "150 mm", .help = "of the gate"},
               {.name = "width", .range = positive, .fallback = "200 mm", .help = "between the side walls"}}};
}

Section test_section() {
  return {.name = "test",
          .help = "The schedule.",
          .keys = {rest_key("60 s", "in the column, before the gate is lifted"),
                   duration_key("180 s"),
                   lift_key("gate_speed", "30 cm/s", "of the lift"),
                   {.name = "bars",
                    .kind = Kind::integer,
                    .range = between(0, 3),
                    .fallback = "0",
                    .help = "0, or 2 or 3 of 12 mm in front of the gate (three dimensions alone)"}}};
}

Section walls_section() {
  return {.name = "walls",
          .help =
              "Contact of the floor, ends, side walls and the column's front wall. With \"no_slip\" the gate "
              "itself is frictionless.",
          .keys = contact_keys(false)};
}

bool in_the_plane(const Values& values) { return values.word("model.space").starts_with("plane"); }

/// Three dimensions start from cells and points that take minutes; a scene that gives one of the two is taken at its
/// word.
void settle_model(Values& values) {
  if (in_the_plane(values)) return;
  const char* note = "the default in three dimensions";
  if (!values.given("model.cell")) values.set_number("model.cell", 0.015, Layer::fallback, note);
  if (values.given("model.points_per_cell")) return;
  values.set_number("model.points_per_cell", 8, Layer::fallback, note);
  values.entries["model.points_per_cell"].numbers.push_back(4);
}

void settle(Values& values) {
  settle_mix(values);
  settle_interface(values, "walls");
  settle_model(values);
  const auto bars = values.integer("test.bars");
  if (bars == 1) values.fail("test.bars", "1 is not allowed; allowed: 0, 2 (class PL1) or 3 (class PL2)");
  if (bars > 0 && in_the_plane(values))
    values.fail("test.bars", fmt::format("{} bars need three dimensions, model.space = \"half\" or \"full\"; "
                                         "in the plane the box has none (bars = 0)",
                                         bars));
  if (bars > 0 && values.word("model.method") == "newton")
    values.fail("model.method",
                "\"newton\" does not know bars; allowed with test.bars: \"auto\" or \"admm\"");
  boxes::check_width(values, static_cast<int>(bars), Box{}.bar_diameter);
  if (values.number("box.channel_height") > values.number("box.column_height"))
    values.fail("box.channel_height",
                fmt::format("is above the column's top; allowed: at most column_height, \"{}\"",
                            write_quantity(values.number("box.column_height"), Dimension::length)));
}

}  // namespace

ApparatusKeys keys() {
  const Section model = model_section({"plane", "plane_with_side_walls", "half", "full"},
                                      {.cell = "10 mm",
                                       .points_per_cell = "[16, 4]",
                                       .cell_help = "[across, up], or one length; 15 mm in three dimensions",
                                       .points_help = "[across, up], or one number for each direction; "
                                                      "[8, 4] in three dimensions"});
  return {.name = "l_box",
          .help = "The L-box test of EN 12350-10.",
          .schema = joined({mix_sections("5 MPa"),
                            {box_section(), test_section(), walls_section(), model, output_section()}}),
          .settle = settle};
}

Scene read_scene(const Values& values) {
  Scene scene;
  scene.mix = read_mix(values);
  scene.box = {values.number("box.column_length"), values.number("box.column_height"),
               values.number("box.channel_length"), values.number("box.channel_height"),
               values.number("box.width")};
  scene.rest = values.number("test.rest");
  scene.duration = values.number("test.duration");
  scene.gate_speed = values.number_unless("test.gate_speed", "instant");
  scene.walls = read_wall_law(values, "walls");
  scene.bars = static_cast<int>(values.integer("test.bars"));
  scene.model = read_model(values);
  scene.frame_interval = read_output(values).frame_interval;
  boxes::check_cells(values, scene);
  return scene;
}

}  // namespace tremie::l_box
