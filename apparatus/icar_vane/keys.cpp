#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/icar_vane/icar_vane.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::icar_vane {

using namespace scene;

namespace {

constexpr double most_cells_with_ends = 3e4;  // of a sector: its factor then takes some 3 GB
constexpr const char* speeds_key = "test.speeds";

/// A key of a flow curve. Its default is set by settle(), where there is a flow curve.
struct CurveKey {
  const char* name;
  Dimension dimension;
  const char* fallback;
  const char* help;
};
constexpr std::array curve_keys{
    CurveKey{"pre_shear_speed", Dimension::rotation, "0.5 rev/s", "with speeds: before the first of them"},
    CurveKey{"pre_shear_time", Dimension::time, "20 s", "with speeds"},
    CurveKey{"hold_time", Dimension::time, "5 s", "with speeds: of each"},
    CurveKey{"average_time", Dimension::time, "2 s",
             "with speeds: the last part of each, for the mean torque"}};

/// What only a vane with ends has. Its default is the gap around the vane.
struct EndKey {
  const char *name, *help;
};
constexpr EndKey bottom_gap{
    "bottom_gap", "cylindrical alone: between blades and floor; the gap to the container if left out"};
constexpr EndKey cover{"cover",
                       "cylindrical alone: concrete above the blades; the gap to the container if left out"};

bool with_ends(const Values& values) { return values.word("model.space") == "cylindrical"; }

Section vane_section() {
  return {
      .name = "vane",
      .help =
          "The vane and its container; the defaults are the ICAR's. In the cylindrical space the vane has "
          "its ends.",
      .keys = {{.name = "radius", .range = positive, .fallback = "63.5 mm", .help = "of the blades' tips"},
               {.name = "height", .range = positive, .fallback = "127 mm"},
               {.name = "container_radius", .range = positive, .fallback = "143 mm"},
               {.name = "blades",
                .kind = Kind::integer,
                .range = between(2, 12),
                .fallback = "4",
                .help = "in the plane; a Couette section has a solid cylinder"},
               {.name = "blade_thickness",
                .range = positive,
                .fallback = "3 mm",
                .help = "in the plane and with ends"},
               {.name = "shaft_radius",
                .range = positive,
                .fallback = "10 mm",
                .help = "in the plane: about which the blades stand; concrete there turns with them; with "
                        "ends it goes up to the surface"},
               {.name = bottom_gap.name, .range = positive, .example = "80 mm", .help = bottom_gap.help},
               {.name = cover.name, .range = positive, .example = "80 mm", .help = cover.help}}};
}

Section test_section() {
  Section section{.name = "test",
                  .help = "The schedule: one constant speed, or with `speeds` a flow curve.",
                  .keys = {rest_key("0 s", "before the vane turns"),
                           {.name = "speed",
                            .dimension = Dimension::rotation,
                            .fallback = "0.25 rev/s",
                            .help = "constant; negative turns the other way"},
                           duration_key("20 s", "at the constant speed"),
                           {.name = "speeds",
                            .dimension = Dimension::rotation,
                            .range = positive,
                            .shape = Shape::list,
                            .example = R"(["0.5 rev/s", "0.3 rev/s", "0.1 rev/s"])",
                            .help = "a flow curve, in place of speed and duration"}}};
  for (const CurveKey& key : curve_keys)
    section.keys.push_back({.name = key.name,
                            .dimension = key.dimension,
                            .range = key.dimension == Dimension::time ? not_negative : positive,
                            .example = key.fallback,
                            .help = key.help});
  section.keys.push_back({.name = "orientation",
                          .dimension = Dimension::angle,
                          .fallback = "0 deg",
                          .help = "of the blades against the points, in the plane"});
  return section;
}

constexpr const char* cylinder_word = "cylinder";

Section walls_section() {
  Section section{.name = "walls",
                  .help =
                      "Of the container: its wall, and its floor where there is one; or of a smooth "
                      "cylinder. What has no law of its own holds the concrete.",
                  .keys = contact_keys(false)};
  std::erase(section.keys.front().words, std::string(FreeSlip::word));
  section.keys.push_back(
      {.name = "surface",
       .kind = Kind::choice,
       .words = {"container", cylinder_word},
       .fallback = "container",
       .only_with = Condition{"contact", {Interface::word}},
       .help = "that slides; the cylinder is a tribometer's, in model.space = \"couette\""});
  return section;
}

bool cylinder_slides(const Values& values) {
  return values.word("walls.contact") == Interface::word && values.word("walls.surface") == cylinder_word;
}

/// Blades hold the concrete between them, and a wall that takes nothing leaves no torque.
void check_walls(const Values& values) {
  if (values.word("walls.contact") != Interface::word) return;
  if (cylinder_slides(values) && values.word("model.space") != "couette")
    values.fail("walls.surface",
                "is \"cylinder\", which a vane has not: its blades hold the concrete between them; allowed: "
                "\"container\", or model.space = \"couette\"");
  const bool holds_nothing = values.number("walls.interface_yield_stress") == 0.0 &&
                             values.number("walls.interface_viscosity") == 0.0;
  if (holds_nothing)
    values.fail("walls.interface_viscosity",
                "is 0, and so is the interface's yield stress: the wall takes nothing from the concrete, and "
                "there is no torque; allowed: one of them above 0");
}

/// The layer of a key as the user gave it; that of the defaults for a key without a value.
Layer layer_of(const Values& values, const std::string& key) {
  return values.has(key) ? values.layer(key) : Layer::fallback;
}

/// One constant speed or a flow curve: what a later layer says wins.
void settle_schedule(Values& values) {
  for (const char* key : {"test.speed", "test.duration"})
    if (values.has(speeds_key) && layer_of(values, key) > values.layer(speeds_key))
      values.drop_beside(speeds_key, key, "");
  if (values.has(speeds_key)) {
    for (const char* key : {"test.speed", "test.duration"})
      values.drop_beside(key, speeds_key,
                         "has no meaning beside test.speeds, a flow curve (pre_shear_speed, pre_shear_time, "
                         "hold_time, average_time); give one or the other");
  }
  for (const CurveKey& key : curve_keys) {
    const std::string full = std::string("test.") + key.name;
    if (!values.has(speeds_key))
      values.drop_beside(full, "test.speed",
                         "needs test.speeds beside it, like speeds = [\"0.5 rev/s\", \"0.1 rev/s\"]");
    else if (!values.has(full))
      values.set_number(full, parse_quantity(key.fallback, key.dimension), Layer::fallback, "");
  }
}

void check_schedule(const Values& values) {
  if (!values.has(speeds_key)) {
    if (values.number("test.speed") == 0.0)
      values.fail("test.speed",
                  "is 0: the vane would not turn; allowed: any other speed, like \"0.25 rev/s\"");
    return;
  }
  if (values.number("test.hold_time") <= 0.0)
    values.fail("test.hold_time", "is 0; it must be greater than 0 s");
  const double average = values.number("test.average_time"), hold = values.number("test.hold_time");
  if (average <= 0.0 || average > hold)
    values.fail("test.average_time",
                fmt::format("is not within the hold; allowed: greater than 0 s and at most hold_time, \"{}\"",
                            write_quantity(hold, Dimension::time)));
}

void check_vane(const Values& values) {
  const double radius = values.number("vane.radius"), container = values.number("vane.container_radius");
  if (radius >= container && values.layer("vane.radius") > values.layer("vane.container_radius"))
    values.fail("vane.radius", fmt::format("does not fit; allowed: less than vane.container_radius, \"{}\"",
                                           write_quantity(container, Dimension::length)));
  if (radius >= container)
    values.fail("vane.container_radius",
                fmt::format("does not hold the vane; allowed: greater than vane.radius, \"{}\"",
                            write_quantity(radius, Dimension::length)));
  if (values.number("vane.shaft_radius") >= radius)
    values.fail("vane.shaft_radius", fmt::format("leaves no blades; allowed: less than vane.radius, \"{}\"",
                                                 write_quantity(radius, Dimension::length)));
  const double n = values.number("vane.blades");
  const double widest = two_pi * radius / n;
  if (values.number("vane.blade_thickness") >= widest)
    values.fail("vane.blade_thickness",
                fmt::format("leaves no room between {:g} blades; allowed: less than \"{}\"", n,
                            write_quantity(widest, Dimension::length)));
}

void settle_cell(Values& values) {
  if (values.has("model.cell")) return;
  const std::string space = values.word("model.space");
  values.set_number("model.cell",
                    space == "couette" ? 0.001
                    : space == "plane" ? 0.005
                                       : 0.009,
                    Layer::fallback, "");
}

void settle_ends(Values& values) {
  for (const EndKey& key : {bottom_gap, cover}) {
    const std::string full = std::string("vane.") + key.name;
    if (!with_ends(values))
      values.drop_beside(full, "model.space",
                         "has a meaning in model.space = \"cylindrical\" alone: sections have no ends");
    else if (!values.has(full))
      values.set_number(full, values.number("vane.container_radius") - values.number("vane.radius"),
                        Layer::fallback, "");
  }
}

/// Steady flow alone: nothing that a run over time would need.
void check_steady(const Values& values, const Scene& scene) {
  if (!with_ends(values)) return;
  if (scene.mix.thixotropy)
    values.fail("model.space",
                "is \"cylindrical\", which is steady flow without flocculation; allowed with mix.thixotropy: "
                "\"couette\", \"plane\"; or leave it out by --set mix.thixotropy=false");
  if (scene.model.method == MethodKind::newton)
    values.fail("model.method",
                "is \"newton\"; allowed in model.space = \"cylindrical\": \"auto\", \"admm\"");
}

void settle(Values& values) {
  settle_mix_with(values, {.layer = true});
  settle_schedule(values);
  settle_interface(values, "walls");
  settle_cell(values);
  check_schedule(values);
  check_vane(values);
  check_walls(values);
  settle_ends(values);
}

/// Cells must resolve the gap, and the points must fit into a computer.
void check_cells(const Values& values, const Scene& scene) {
  const double R = scene.vane.container_radius, gap = R - scene.vane.radius;
  const auto [across, up] = scene.model.cell;
  const bool couette = scene.model.space == SpaceKind::couette;
  if (across > gap || (!couette && up > gap))
    values.fail("model.cell",
                fmt::format("is larger than the gap between vane and container; allowed: at most \"{}\"",
                            write_at_most(gap, Dimension::length)));
  if (with_ends(values)) {
    const double least =
        std::min({scene.vane.bottom_gap, scene.vane.cover, scene.vane.height, scene.vane.radius});
    if (2.0 * across > least * (1.0 + 1e-9))
      values.fail(
          "model.cell",
          fmt::format("leaves less than two cells to the vane, its gap or its cover; allowed: at most \"{}\"",
                      write_at_most(0.5 * least, Dimension::length)));
    const double height = scene.vane.bottom_gap + scene.vane.height + scene.vane.cover;
    const double cells = R / across * height / across * two_pi * scene.vane.radius / scene.vane.blades / up;
    if (cells > most_cells_with_ends)
      values.fail("model.cell",
                  fmt::format("makes about {:.0e} cells; allowed in the cylindrical space: at most {:.0e}",
                              cells, most_cells_with_ends));
    return;
  }
  const auto [n_across, n_up] = scene.model.points_per_cell;
  const double points =
      couette ? gap / across * n_across
              : R / across * n_across * two_pi * scene.vane.radius / scene.vane.blades / up * n_up;
  check_points(values, points);
}

/// rad/s as rev/s, in the digits that a person would have written where those mean the same: "0.1 rev/s"
/// stays 0.1.
double revolutions(double omega) {
  const double exact = omega / two_pi;
  const double short_one = std::strtod(fmt::format("{:.15g}", exact).c_str(), nullptr);
  return short_one * two_pi == omega ? short_one : exact;
}

void read_schedule(const Values& values, Scene& scene) {
  scene.rest = values.number("test.rest");
  if (!values.has(speeds_key)) {
    scene.speed = revolutions(values.number("test.speed"));
    scene.duration = values.number("test.duration");
    return;
  }
  for (const double omega : values.numbers(speeds_key)) scene.speeds.push_back(revolutions(omega));
  scene.pre_shear_speed = revolutions(values.number("test.pre_shear_speed"));
  scene.pre_shear_time = values.number("test.pre_shear_time");
  scene.hold_time = values.number("test.hold_time");
  scene.average_time = values.number("test.average_time");
}

}  // namespace

ApparatusKeys keys() {
  const Section model = model_section(
      {"couette", "plane", "cylindrical"},
      {.cell = "",
       .points_per_cell = "3",
       .cell_help = "1 mm for \"couette\", 5 mm for \"plane\", 9 mm for \"cylindrical\", if left out; in the "
                    "last two [along the radius (and the height), around at the tips]",
       .points_help = "[across, up], or one number for each direction"});
  return {.name = "icar_vane",
          .help = "The ICAR vane rheometer: a vane turning in a container of concrete.",
          .schema = joined(
              {mix_sections(), {vane_section(), test_section(), walls_section(), model, output_section()}}),
          .settle = settle};
}

Scene read_scene(const Values& values) {
  Scene scene;
  scene.mix = read_mix(values);
  scene.vane = {values.number("vane.radius"),           values.number("vane.height"),
                values.number("vane.container_radius"), static_cast<int>(values.integer("vane.blades")),
                values.number("vane.blade_thickness"),  values.number("vane.shaft_radius")};
  if (with_ends(values))
    scene.vane.bottom_gap = values.number("vane.bottom_gap"), scene.vane.cover = values.number("vane.cover");
  read_schedule(values, scene);
  scene.walls = read_wall_law(values, "walls");
  scene.cylinder_slides = cylinder_slides(values);
  scene.orientation = values.number("test.orientation");
  scene.model = read_model(values);
  scene.frame_interval = read_output(values).frame_interval;
  check_steady(values, scene);
  check_cells(values, scene);
  return scene;
}

}  // namespace tremie::icar_vane
