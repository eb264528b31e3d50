#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "apparatus/bored_pile/bored_pile.hpp"
#include "apparatus/common/law_keys.hpp"

namespace tremie::bored_pile {

using namespace scene;

namespace {

Schema pile_sections() {
  return {
      {.name = "pile",
       .help = "The bore.",
       .keys = {{.name = "radius", .range = positive, .fallback = "0.75 m"},
                {.name = "depth", .range = positive, .fallback = "16 m"}}},
      {.name = "pipe",
       .help = "The tremie pipe, in the middle of the pile.",
       .keys =
           {{.name = "inner_radius", .range = positive, .fallback = "125 mm"},
            {.name = "outer_radius", .range = positive, .fallback = "135 mm"},
            {.name = "embedment",
             .range = not_negative,
             .shape = Shape::list,
             .fallback = "[\"2 m\", \"6 m\"]",
             .help = "[least, most] of its mouth below the concrete's mean level"},
            {.name = "pull",
             .range = positive,
             .fallback = "3 m",
             .help = "withdrawn at a time, when the most is reached; in whole cells"},
            {.name = "start",
             .range = positive,
             .fallback = "0.25 m",
             .help =
                 "of the mouth over the base at first; the first charge is there up to two cells above it"},
            {.name = "above",
             .range = not_negative,
             .fallback = "2 m",
             .help = "top of the pipe or of its hopper over the pile's top: what head there can be"}}},
      {.name = "fluid",
       .help = "What the concrete displaces, up to the pile's top.",
       .keys = {{.name = "density",
                 .dimension = Dimension::density,
                 .range = not_negative,
                 .fallback = "1100 kg/m3"}}},
      {.name = "test",
       .help = "The pour.",
       .keys = {{.name = "rate", .dimension = Dimension::flow, .range = positive, .fallback = "27 m3/h"},
                {.name = "workable",
                 .dimension = Dimension::time,
                 .range = positive,
                 .fallback = "4 h",
                 .help = "age up to which the concrete is; older concrete that moves is told"}}},
      {.name = "load",
       .help = "Loads in the order of placing; left out: one that fills the pile.",
       .keys = {{.name = "volume",
                 .dimension = Dimension::volume,
                 .range = positive,
                 .required = true,
                 .example = "8 m3"},
                {.name = "age",
                 .dimension = Dimension::time,
                 .range = not_negative,
                 .fallback = "0 min",
                 .help = "since batching, when it is placed"},
                {.name = "rest",
                 .dimension = Dimension::time,
                 .range = not_negative,
                 .fallback = "0 min",
                 .help = "of it without agitation: what its flocculation state begins with"},
                {.name = "pause",
                 .dimension = Dimension::time,
                 .range = not_negative,
                 .fallback = "0 min",
                 .help = "of the pour, before it"},
                {.name = "yield_stress",
                 .dimension = Dimension::pressure,
                 .range = not_negative,
                 .example = "80 Pa",
                 .help = "of this load's mix; left out: as in [mix]"},
                {.name = "plastic_viscosity",
                 .dimension = Dimension::viscosity,
                 .range = positive,
                 .example = "50 Pa.s",
                 .help = "likewise"},
                {.name = "structuration_rate",
                 .dimension = Dimension::structuration,
                 .range = not_negative,
                 .example = "0.5 Pa/s",
                 .help = "likewise, beside [mix.thixotropy]"}},
       .repeated = true},
      {.name = "walls",
       .help = "Of the bore; its base and the pipe's outside hold the concrete.",
       .keys = contact_keys(false)},
      {.name = "cage",
       .help = "Reinforcement; left out: none.",
       .keys = {{.name = "radius",
                 .range = positive,
                 .fallback = "0.65 m",
                 .help = "of the circle through the axes of the upright bars"},
                {.name = "bars", .kind = Kind::integer, .range = between(1, 1000), .fallback = "16"},
                {.name = "bar_diameter", .range = positive, .fallback = "32 mm"},
                {.name = "hoop_spacing",
                 .range = not_negative,
                 .fallback = "150 mm",
                 .help = "from hoop to hoop; 0: no hoops"},
                {.name = "hoop_diameter", .range = positive, .fallback = "16 mm"}},
       .optional = true}};
}

void check_embedment(const Values& values) {
  const auto embedment = values.numbers("pipe.embedment");
  if (embedment.size() != 2 || embedment[0] >= embedment[1])
    values.fail("pipe.embedment", "needs the least and the most, like [\"2 m\", \"6 m\"]");
  const double most = embedment[1] - embedment[0];
  if (values.number("pipe.pull") > most * (1.0 + 1e-9))
    values.fail("pipe.pull",
                fmt::format("leaves less than the least embedment; allowed: at most \"{}\", most less least",
                            write_quantity(most, Dimension::length)));
}

void settle(Values& values) {
  settle_mix(values);
  settle_interface(values, "walls");
  if (values.word("model.scheme") != "implicit")
    values.fail("model.scheme", "explicit steps have no inlet; allowed: \"implicit\"");
  check_embedment(values);
}

/// The pipe must fit into the pile, and what is poured into both.
void check_pile(const Values& values, const Scene& scene) {
  const Pipe& pipe = scene.pipe;
  const auto length = [](double x) { return write_quantity(x, Dimension::length); };
  if (pipe.outer_radius <= pipe.inner_radius)
    values.fail("pipe.outer_radius",
                fmt::format("is not larger than inner_radius, \"{}\"", length(pipe.inner_radius)));
  const auto [h, h_up] = scene.model.cell;
  if (pipe.outer_radius + 2.0 * h > scene.radius)
    values.fail(
        "pipe.outer_radius",
        fmt::format(
            "leaves less than two cells between pipe and pile; allowed: less than \"{}\" on these cells",
            length(std::max(0.0, scene.radius - 2.0 * h))));
  if (pipe.start + 4.0 * h_up > scene.depth)
    values.fail("pipe.start",
                fmt::format("the mouth stands above the pile; allowed: less than \"{}\" on these cells",
                            length(std::max(0.0, scene.depth - 4.0 * h_up))));
  if (h > pipe.outer_radius || h_up > pipe.pull)
    values.fail("model.cell", fmt::format("does not resolve the pipe; allowed: at most [\"{}\", \"{}\"]",
                                          length(pipe.outer_radius), length(pipe.pull)));
  if (scene.fluid_density >= scene.mix.density)
    values.fail("fluid.density",
                fmt::format("the concrete would float; allowed: less than mix.density, \"{}\"",
                            write_quantity(scene.mix.density, Dimension::density)));
  const double first = std::numbers::pi * scene.radius * scene.radius * (pipe.start + 3.0 * h_up);
  if (scene.loads.front().volume < first)
    values.fail(values.count("load") > 0 ? "load[0].volume" : "pile.depth",
                fmt::format("the first load does not cover the pipe's mouth; allowed: at least \"{}\"",
                            write_quantity(first, Dimension::volume)));
  const auto [n, n_up] = scene.model.points_per_cell;
  check_points(values, scene.radius / h * n * scene.depth / h_up * n_up);
}

/// The drag of a row of bars holds from three diameters on; the cover needs cells of its own.
void check_cage(const Values& values, const Scene& scene) {
  const Cage& cage = *scene.cage;
  const auto length = [](double x) { return write_quantity(x, Dimension::length); };
  const double h = scene.model.cell[0], least = scene.pipe.outer_radius + h, most = scene.radius - 2.0 * h;
  if (cage.radius < least || cage.radius > most)
    values.fail(
        "cage.radius",
        fmt::format("needs a cell to the pipe and two to the wall; allowed: \"{}\" to \"{}\" on these "
                    "cells",
                    length(least), length(std::max(least, most))));
  const auto row = [&](const char* key, double diameter, double spacing) {
    if (diameter > spacing / 3.0)
      values.fail(
          key, fmt::format("leaves gaps for which no drag is known; allowed: at most a third of the spacing, "
                           "\"{}\"",
                           length(spacing / 3.0)));
  };
  row("cage.bar_diameter", cage.bar_diameter, cage.bar_spacing());
  if (cage.hoop_spacing > 0.0) row("cage.hoop_diameter", cage.hoop_diameter, cage.hoop_spacing);
}

std::optional<Cage> read_cage(const Values& values) {
  if (!values.has_section("cage")) return std::nullopt;
  return Cage{values.number("cage.radius"), static_cast<int>(values.integer("cage.bars")),
              values.number("cage.bar_diameter"), values.number("cage.hoop_spacing"),
              values.number("cage.hoop_diameter")};
}

/// The mix of load i: what the load leaves out is the scene's.
Mix read_mix_of_load(const Values& values, const Scene& scene, std::size_t i) {
  Mix mix = scene.mix;
  const auto key = [i](const char* name) { return fmt::format("load[{}].{}", i, name); };
  const auto read = [&](const char* name, double& number) {
    if (values.has(key(name))) number = values.number(key(name));
  };
  if (values.has(key("plastic_viscosity")) && is_viscous(scene.model.law))
    values.fail(key("plastic_viscosity"),
                "has no meaning beside mix.consistency, which holds for all loads; allowed here: yield_stress, "
                "structuration_rate");
  if (values.has(key("structuration_rate")) && !mix.thixotropy)
    values.fail(key("structuration_rate"), "needs [mix.thixotropy], whose kinetics hold for all loads");
  read("yield_stress", mix.tau_0), read("plastic_viscosity", mix.mu);
  if (!mix.thixotropy) return mix;
  read("structuration_rate", mix.thixotropy->A_thix);
  if (mix.tau_0 == 0.0)
    values.fail(key("yield_stress"), "is 0 with [mix.thixotropy]; allowed: greater than 0 Pa");
  return mix;
}

/// The mixes of the loads; empty where all are the scene's.
std::vector<Mix> read_mixes(const Values& values, const Scene& scene) {
  const auto is_scenes = [&](const Mix& mix) {
    return mix.tau_0 == scene.mix.tau_0 && mix.mu == scene.mix.mu &&
           (!mix.thixotropy || mix.thixotropy->A_thix == scene.mix.thixotropy->A_thix);
  };
  std::vector<Mix> mixes;
  for (std::size_t i = 0; i < values.count("load"); ++i) mixes.push_back(read_mix_of_load(values, scene, i));
  if (std::all_of(mixes.begin(), mixes.end(), is_scenes)) return {};
  if (scene.model.method == MethodKind::newton)
    values.fail("model.method", "\"newton\" knows one mix for all loads; allowed: \"auto\", \"admm\"");
  return mixes;
}

std::vector<Load> read_loads(const Values& values) {
  std::vector<Load> loads;
  for (std::size_t i = 0; i < values.count("load"); ++i) {
    const auto of = [&](const char* key) { return values.number(fmt::format("load[{}].{}", i, key)); };
    loads.push_back({of("volume"), of("age"), of("pause"), of("rest")});
  }
  return loads;
}

}  // namespace

ApparatusKeys keys() {
  const Section model =
      model_section({"axisymmetric"}, {.cell = "45 mm",
                                       .points_per_cell = "3",
                                       .cell_help = "[across, up], or one length; across so that "
                                                    "the pipe's outside lies on a face"});
  return {.name = "bored_pile",
          .help = "The pour of a bored pile through a tremie pipe.",
          .schema = joined({mix_sections("350 MPa"), pile_sections(), {model, output_section()}}),
          .settle = settle};
}

double pile_volume(const Scene& scene) {
  return std::numbers::pi * scene.radius * scene.radius * scene.depth;
}

double pour_time(const Scene& scene) {
  double volume = 0.0, pauses = 0.0;
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    if (volume < pile_volume(scene) && i > 0) pauses += scene.loads[i].pause;
    volume += scene.loads[i].volume;
  }
  return pauses + std::min(volume, pile_volume(scene)) / scene.rate;
}

Scene read_scene(const Values& values) {
  Scene scene;
  scene.mix = read_mix(values);
  scene.radius = values.number("pile.radius"), scene.depth = values.number("pile.depth");
  const auto embedment = values.numbers("pipe.embedment");
  scene.pipe = {values.number("pipe.inner_radius"),
                values.number("pipe.outer_radius"),
                embedment[0],
                embedment[1],
                values.number("pipe.pull"),
                values.number("pipe.start"),
                values.number("pipe.above")};
  scene.fluid_density = values.number("fluid.density");
  scene.rate = values.number("test.rate"), scene.workable = values.number("test.workable");
  scene.loads = read_loads(values);
  if (scene.loads.empty()) scene.loads = {{.volume = pile_volume(scene)}};
  scene.walls = read_wall_law(values, "walls");
  scene.model = read_model(values);
  scene.frame_interval = read_output(values).frame_interval;
  scene.cage = read_cage(values);
  scene.mixes = read_mixes(values, scene);
  check_pile(values, scene);
  if (scene.cage) check_cage(values, scene);
  return scene;
}

}  // namespace tremie::bored_pile
