#include <fmt/format.h>

#include "apparatus/bored_pile/bored_pile.hpp"
#include "apparatus/common/law_keys.hpp"

namespace tremie::bored_pile {

using namespace scene;

namespace {

Schema pile_sections() {
  return {
      {.name = "pile",
       .help = "The bore.",
       .keys =
           {{.name = "radius", .range = positive, .fallback = "0.75 m", .help = "half the length of a panel"},
            {.name = "depth", .range = positive, .fallback = "16 m"},
            {.name = "width",
             .range = positive,
             .example = "0.8 m",
             .help = "of a panel, with model.space = \"plane_with_side_walls\" or \"plane\""}}},
      {.name = "pipe",
       .help = "The tremie pipe, in the middle of the pile or panel.",
       .keys = {{.name = "inner_radius", .range = positive, .fallback = "125 mm"},
                {.name = "outer_radius", .range = positive, .fallback = "135 mm"},
                {.name = "embedment",
                 .range = not_negative,
                 .shape = Shape::list,
                 .fallback = "[\"2 m\", \"6 m\"]",
                 .help = "[least, most]: depth of the pipe's mouth below the concrete's mean level"},
                {.name = "pull",
                 .range = positive,
                 .fallback = "3 m",
                 .help = "length of pipe withdrawn at a time, once the greatest embedment is reached; in "
                         "whole cells"},
                {.name = "start",
                 .range = positive,
                 .fallback = "0.25 m",
                 .help = "initial height of the mouth above the base; the first charge fills the pile to two "
                         "cells above the mouth"},
                {.name = "above",
                 .range = not_negative,
                 .fallback = "2 m",
                 .help = "height of the top of the pipe, or of its hopper, above the pile's top: limits the "
                         "driving head"}}},
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
                 .help = "age since batching up to which the concrete is workable; older concrete that still "
                         "moves is reported"}}},
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
                 .help = "age since batching at placing"},
                {.name = "rest",
                 .dimension = Dimension::time,
                 .range = not_negative,
                 .fallback = "0 min",
                 .help = "time without agitation before placing: sets the load's initial flocculation state"},
                {.name = "pause",
                 .dimension = Dimension::time,
                 .range = not_negative,
                 .fallback = "0 min",
                 .help = "pause of the pour before this load"},
                {.name = "yield_stress",
                 .dimension = Dimension::pressure,
                 .range = not_negative,
                 .example = "80 Pa",
                 .help = "yield stress of this load's mix; left out: as in [mix]"},
                {.name = "plastic_viscosity",
                 .dimension = Dimension::viscosity,
                 .range = positive,
                 .example = "50 Pa.s",
                 .help = "plastic viscosity of this load's mix; left out: as in [mix]"},
                {.name = "structuration_rate",
                 .dimension = Dimension::structuration,
                 .range = not_negative,
                 .example = "0.5 Pa/s",
                 .help =
                     "structuration rate of this load's mix, beside [mix.thixotropy]; left out: as there"}},
       .repeated = true},
      {.name = "walls",
       .help = "Contact of the bore's wall; its base and the pipe's outside are without slip.",
       .keys = contact_keys(false)},
      {.name = "cage",
       .help = "Reinforcement; left out: none.",
       .keys = {{.name = "radius",
                 .range = positive,
                 .fallback = "0.65 m",
                 .help = "radius of the circle through the axes of the upright bars"},
                {.name = "bars", .kind = Kind::integer, .range = between(1, 1000), .fallback = "16"},
                {.name = "bar_diameter", .range = positive, .fallback = "32 mm"},
                {.name = "hoop_spacing",
                 .range = not_negative,
                 .fallback = "150 mm",
                 .help = "distance from hoop to hoop; 0: no hoops"},
                {.name = "hoop_diameter", .range = positive, .fallback = "16 mm"}},
       .optional = true}};
}

void check_embedment(const Values& values) {
  const auto embedment = values.numbers("pipe.embedment");
  if (embedment.size() != 2 || embedment[0] >= embedment[1])
    values.fail("pipe.embedment",
                "needs the least and the most, the smaller one first, like [\"2 m\", \"6 m\"]");
  const double most = embedment[1] - embedment[0];
  if (values.number("pipe.pull") > most * (1.0 + 1e-9))
    values.fail("pipe.pull",
                fmt::format("leaves less than the least embedment; allowed: at most \"{}\", most less least",
                            write_at_most(most, Dimension::length)));
}

/// A panel is a plane with a width. What a cage's long sides do lies in that plane.
void check_space(const Values& values) {
  const std::string& space = values.word("model.space");
  const bool plane = space != "axisymmetric";
  if (plane && !values.has("pile.width"))
    values.fail(
        "model.space",
        fmt::format("\"{}\" is a panel and needs pile.width beside it, like width = \"0.8 m\"", space));
  if (!plane && values.has("pile.width"))
    values.fail("pile.width",
                "is a panel's; allowed: with model.space = \"plane\" or \"plane_with_side_walls\"");
  if (plane && values.has_section("cage"))
    values.fail(
        "model.space",
        fmt::format("\"{}\" has no cage, whose long sides lie in the section; allowed: no [cage]", space));
}

void settle(Values& values) {
  settle_mix(values);
  settle_interface(values, "walls");
  if (values.word("model.scheme") != "implicit")
    values.fail("model.scheme", "explicit steps have no inlet; allowed: \"implicit\"");
  check_embedment(values);
  check_space(values);
}

}  // namespace

ApparatusKeys keys() {
  const Section model = model_section({"axisymmetric", "plane", "plane_with_side_walls"},
                                      {.cell = "45 mm",
                                       .points_per_cell = "3",
                                       .cell_help = "[across, up], or one length; across so that "
                                                    "the pipe's outside lies on a face"});
  return {.name = "bored_pile",
          .help = "The pour of a bored pile, or of a panel, through a tremie pipe.",
          .schema = joined({mix_sections("350 MPa"), pile_sections(), {model, output_section()}}),
          .settle = settle};
}

}  // namespace tremie::bored_pile
