#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/parts/funnel/funnel.hpp"

namespace tremie::funnel {

using namespace scene;

namespace {

/// Fewer cells across the mouth let too little through.
constexpr double least_across_mouth = 3.0;

std::string in_mm(double length) { return fmt::format("{:g} mm", mm * length); }

Section funnel_section(const FunnelTest& test) {
  const Shape& s = test.standard;
  const char* wide = s.depth > 0.0 ? "width between the tapering walls" : "diameter";
  std::vector<Key> keys{
      {.name = "top", .range = positive, .fallback = in_mm(s.top), .help = std::string("its ") + wide},
      {.name = "mouth", .range = positive, .fallback = in_mm(s.mouth), .help = "the same at the mouth"},
      {.name = "pipe",
       .range = not_negative,
       .fallback = in_mm(s.pipe),
       .help = "height of the straight part at the top"},
      {.name = "taper",
       .range = not_negative,
       .fallback = in_mm(s.taper),
       .help = "height of the taper below it"},
      {.name = "throat",
       .range = not_negative,
       .fallback = in_mm(s.throat),
       .help = "height of the straight part above the mouth"}};
  if (s.depth > 0.0)
    keys.push_back(
        {.name = "depth", .range = positive, .fallback = in_mm(s.depth), .help = "between the side walls"});
  keys.push_back({.name = "name", .kind = Kind::text, .help = "what people call it"});
  keys.push_back({.name = "standard", .kind = Kind::text, .help = "that describes it"});
  return {.name = "funnel",
          .help = fmt::format(
              "Inner dimensions; the defaults are those of reference_data/funnels/{0}.toml. Or funnel = "
              "\"{0}\", a name from that folder, or a path to a .toml file.",
              test.name),
          .keys = std::move(keys)};
}

Section test_section() {
  return {.name = "test",
          .help = "The schedule.",
          .keys = {rest_key("0 s", "in the funnel, before the mouth opens"),
                   duration_key("60 s", "at most; the test ends when light is seen through the mouth")}};
}

Section walls_section() { return {.name = "walls", .help = "Of the funnel.", .keys = contact_keys(false)}; }

void settle(Values& values) {
  settle_mix(values);
  settle_interface(values, "walls");
  for (const char* height : {"funnel.pipe", "funnel.taper", "funnel.throat"})
    if (values.number(height) > 0.0) return;
  values.fail("funnel.taper", "the funnel has no height; allowed: a pipe, a taper or a throat above 0 mm");
}

/// A funnel is nowhere narrower than its mouth, and its parts fit each other.
void check_shape(const Values& values, const Shape& s) {
  if (s.top < s.mouth)
    values.fail("funnel.mouth", fmt::format("is wider than the top; allowed: at most \"{}\"",
                                            write_quantity(s.top, Dimension::length)));
  if (s.taper == 0.0 && s.top != s.mouth)
    values.fail("funnel.taper", "a top that is wider than the mouth needs a taper; allowed: above 0 mm");
}

/// The cells must resolve the mouth, and the points must fit into a computer.
void check_cells(const Values& values, const Scene& scene) {
  const auto [across, up] = scene.model.cell;
  const double most = scene.shape.mouth / least_across_mouth;
  if (across > most * (1.0 + 1e-9) || up > most * (1.0 + 1e-9))
    values.fail("model.cell",
                fmt::format("is too large for the mouth, which needs {:g} cells; allowed: at most \"{}\"",
                            least_across_mouth, write_at_most(most, Dimension::length)));
  const auto [n_across, n_up] = scene.model.points_per_cell;
  check_points(values, 0.5 * scene.shape.top / across * n_across * height(scene.shape) / up * n_up);
}

Shape shape_of(const Values& values) {
  Shape s{.top = values.number("funnel.top"),
          .mouth = values.number("funnel.mouth"),
          .pipe = values.number("funnel.pipe"),
          .taper = values.number("funnel.taper"),
          .throat = values.number("funnel.throat")};
  if (values.has("funnel.depth")) s.depth = values.number("funnel.depth");
  return s;
}

}  // namespace

ApparatusKeys keys(const FunnelTest& test) {
  const std::vector<std::string> spaces = test.standard.depth > 0.0
                                              ? std::vector<std::string>{"plane_with_side_walls", "plane"}
                                              : std::vector<std::string>{"axisymmetric"};
  const Section model =
      model_section(spaces, {.cell = test.cell,
                             .points_per_cell = "4",
                             .cell_help = "[across, up], or one length; at most a third of the mouth",
                             .points_help = "[across, up], or one number for each direction",
                             .space_help = test.standard.depth > 0.0
                                               ? "no three dimensions: a quarter of it on cells that resolve "
                                                 "the mouth takes half an hour of one core"
                                               : "no three dimensions: a round funnel is the same in every "
                                                 "section through its axis"});
  return {
      .name = test.name,
      .help = test.help,
      .schema = joined({mix_sections("10 MPa"),
                        {funnel_section(test), test_section(), walls_section(), model, output_section()}}),
      .settle = settle};
}

Scene read_scene(const Values& values) {
  Scene scene;
  scene.mix = read_mix(values);
  scene.shape = shape_of(values);
  scene.rest = values.number("test.rest");
  scene.duration = values.number("test.duration");
  scene.walls = read_wall_law(values, "walls");
  scene.model = read_model(values);
  scene.frame_interval = read_output(values).frame_interval;
  check_shape(values, scene.shape);
  check_cells(values, scene);
  return scene;
}

}  // namespace tremie::funnel
