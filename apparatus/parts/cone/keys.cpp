#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "apparatus/common/shared_keys.hpp"
#include "apparatus/parts/cone/readings.hpp"
#include "apparatus/parts/rest_profile.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::cone {

using namespace scene;

namespace {

Section cone_section() {
  return {.name = "cone",
          .help =
              "Inner dimensions; the defaults are the Abrams cone's. Or cone = \"haegermann\", a name from "
              "reference_data/cones, or a path to a .toml file.",
          .keys = {{.name = "top_radius", .range = positive, .fallback = "50 mm"},
                   {.name = "bottom_radius", .range = positive, .fallback = "100 mm"},
                   {.name = "height", .range = positive, .fallback = "300 mm"},
                   {.name = "name", .kind = Kind::text, .help = "what people call it"},
                   {.name = "standard", .kind = Kind::text, .help = "that describes it"}}};
}

Section test_section() {
  return {.name = "test",
          .help = "The schedule.",
          .keys = {rest_key("0 s", "before the lift"),
                   duration_key("30 s"),
                   lift_key("lift_speed", "15 cm/s", "of the cone"),
                   {.name = "rest_tolerance",
                    .kind = Kind::number,
                    .range = {.low = 0.0, .high = 0.1, .low_open = true},
                    .fallback = "0.002",
                    .help = "the flow has stopped when it would gain less than this share of its spread"}}};
}

Cone cone_of(const Values& values) {
  return {values.number("cone.top_radius"), values.number("cone.bottom_radius"),
          values.number("cone.height")};
}

/// Rows of cells that a film is thick, on average, where it will rest. Six rows leave its spread 1 % short; twelve would have
/// a point in too few of them when the film begins.
constexpr double rows_at_rest = 8.0;

/// The mean depth [m] of what the cone holds where it will rest on a floor that holds it; infinite without a yield stress.
double depth_at_rest(const Scene& scene) {
  if (scene.mix.tau_0 == 0.0) return INFINITY;
  const double V = volume(scene.cone),
               R = parts::rest_radius(V, scene.mix.tau_0 / (scene.mix.density * gravity));
  return V / (std::numbers::pi * R * R);
}

/// Wider out of the Abrams cone a body is a film [m]; t500 is read on the cells that the flow began on.
constexpr double film_spread = 0.52;

/// A body that is deeper than this many times its depth at rest is no film: on cells that flat its front would stand.
constexpr double deepest_film = 2.0;

constexpr double default_height = 0.005;  ///< of a section's cells, for the Abrams cone [m]

}  // namespace

double film_cell_of(const Scene& scene) {
  const double up = scene.model.cell[1], to_default = up / (default_height * scale_of(scene.cone));
  if (scene.model.space != SpaceKind::axisymmetric || scene.model.scheme != SchemeKind::implicit) return up;
  return std::min(up, to_default * depth_at_rest(scene) / rows_at_rest);
}

double film_spread_of(const Scene& scene) {
  const double deepest = deepest_film * depth_at_rest(scene);
  return std::max(film_spread * scale_of(scene.cone),
                  2.0 * std::sqrt(volume(scene.cone) / (std::numbers::pi * deepest)));
}

namespace {

/// Three dimensions start from cells and points that a desk computer carries; a scene that gives one of the
/// two is taken at its word. The body stretches across and is pressed flat: four points across a cell become
/// two, and with two at the start the spread is 6 % too far on any cells (three_d.md). Cells are as large to any cone as
/// these to the Abrams cone.
void settle_model(Values& values) {
  const bool section = values.word("model.space") == "axisymmetric",
             implicit = values.word("model.scheme") == "implicit";
  const double scale = scale_of(cone_of(values));
  if (section && scale == 1.0) return;
  const char* note = section ? "the default, for the size of the cone" : "the default in three dimensions";
  std::vector<double> cell = section    ? values.numbers("model.cell")
                             : implicit ? std::vector{0.014, 0.007}
                                        : std::vector{0.015};
  for (double& h : cell) h *= scale;
  if (!values.given("model.cell")) values.set_numbers("model.cell", cell, Layer::fallback, note);
  if (section) return;
  const std::vector<double> points = implicit ? std::vector{4.0, 2.0} : std::vector{2.0};
  if (!values.given("model.points_per_cell"))
    values.set_numbers("model.points_per_cell", points, Layer::fallback, note);
}

/// FLIP sums in double precision alone.
void settle_precision(Values& values) {
  if (!values.has("model.precision") || values.word("model.precision") != "single") return;
  if (values.word("model.transfer") == "flip")
    values.drop_beside("model.precision", "model.transfer",
                       "is \"single\", which goes with model.transfer = \"apic\" alone");
}

/// Cells must resolve the cone, and the points must fit into a computer.
void check_cells(const Values& values, const Scene& scene) {
  const auto [across, up] = scene.model.cell;
  if (across > scene.cone.bottom_radius || up > scene.cone.height) {
    values.fail("model.cell", fmt::format("is larger than the cone; allowed: at most [\"{}\", \"{}\"]",
                                          write_quantity(scene.cone.bottom_radius, Dimension::length),
                                          write_quantity(scene.cone.height, Dimension::length)));
  }
  const auto [n_across, n_up] = scene.model.points_per_cell;
  const bool axisymmetric = scene.model.space == SpaceKind::axisymmetric;
  const double columns = scene.cone.bottom_radius / across * n_across;
  const double share = scene.model.space == SpaceKind::quarter ? 0.25 : 1.0;
  const double points =
      (axisymmetric ? columns : share * 3.1416 * columns * columns) * scene.cone.height / up * n_up;
  check_points(values, points);
}

/// Only the Abrams cone, either way up, has a time to 500 mm.
void check_measured(const Values& values, const Scene& scene) {
  if (values.given("measured.t500") && !is_abrams(scene.cone, true))
    values.fail("measured.t500",
                "is read with the Abrams cone alone; leave it out, or use cone = \"abrams\"");
}

}  // namespace

void settle(Values& values) {
  settle_model(values);
  settle_precision(values);
  settle_mix(values);
  settle_floor(values);
}

Schema sections() { return {cone_section(), test_section()}; }

Scene read_scene(const Values& values) {
  Scene scene;
  scene.mix = read_mix(values);
  scene.cone = cone_of(values);
  scene.floor = read_floor(values);
  scene.rest = values.number("test.rest");
  scene.duration = values.number("test.duration");
  scene.rest_tolerance = values.number("test.rest_tolerance");
  scene.lift_speed = values.number_unless("test.lift_speed", "instant");
  scene.model = read_model(values);
  scene.film_cell = film_cell_of(scene);
  scene.film_spread = film_spread_of(scene);
  scene.frame_interval = read_output(values).frame_interval;
  check_cells(values, scene);
  check_measured(values, scene);
  return scene;
}

}  // namespace tremie::cone
