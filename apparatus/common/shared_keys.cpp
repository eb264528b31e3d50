#include "apparatus/common/shared_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/thixotropy_keys.hpp"
#include "libmpm/constitutive/equation_of_state.hpp"

namespace tremie::scene {
namespace {

const Words<SpaceKind> space_words{{"axisymmetric", SpaceKind::axisymmetric},
                                   {"quarter", SpaceKind::quarter},
                                   {"full", SpaceKind::full},
                                   {"plane", SpaceKind::plane},
                                   {"plane_with_side_walls", SpaceKind::plane_with_side_walls},
                                   {"couette", SpaceKind::couette},
                                   {"half", SpaceKind::half},
                                   {"cylindrical", SpaceKind::cylindrical}};
const Words<SchemeKind> scheme_words{{"implicit", SchemeKind::implicit},
                                     {"explicit", SchemeKind::explicit_usl},
                                     {"explicit_usf", SchemeKind::explicit_usf}};
const Words<MethodKind> method_words{
    {"auto", MethodKind::automatic}, {"admm", MethodKind::admm}, {"newton", MethodKind::newton}};
const Words<ShapeKind> shape_words{{"b_spline", ShapeKind::b_spline}, {"gimp", ShapeKind::gimp}};
const Words<PressureKind> pressure_words{{"cell", PressureKind::cell}, {"point", PressureKind::point}};
const Words<TransferKind> transfer_words{{"apic", TransferKind::apic}, {"flip", TransferKind::flip}};
const Words<PrecisionKind> precision_words{{"double", PrecisionKind::both_double},
                                           {"single", PrecisionKind::single_sums}};

Section material_section(const std::string& bulk_modulus) {
  Section section{
      .name = "mix",
      .help = "The concrete. In place of the table: mix = \"mix_a\", a name from reference_data/mixes.",
      .keys = {
          {.name = "yield_stress",
           .dimension = Dimension::pressure,
           .range = not_negative,
           .required = true,
           .example = "54 Pa",
           .help = "dynamic yield stress, tau_0"},
          {.name = "density", .dimension = Dimension::density, .range = positive, .fallback = "2400 kg/m3"},
          {.name = "bulk_modulus",
           .dimension = Dimension::pressure,
           .range = positive,
           .fallback = bulk_modulus,
           .help = "K; or youngs_modulus and poisson_ratio"},
          {.name = "shear_modulus",
           .dimension = Dimension::pressure,
           .range = positive,
           .example = "2 kPa",
           .help = "G: elastic below the yield stress; cell alone, flows are rigid there"},
          {.name = "youngs_modulus",
           .dimension = Dimension::pressure,
           .range = positive,
           .example = "0.01 MPa",
           .help = "in place of bulk_modulus"},
          {.name = "poisson_ratio",
           .kind = Kind::number,
           .range = {.low = -1.0, .high = 0.5, .low_open = true, .high_open = true},
           .example = "0.45",
           .help = "with youngs_modulus"},
          {.name = "name", .kind = Kind::text, .help = "what people call it"},
          {.name = "source", .kind = Kind::text, .help = "where its numbers come from"},
          {.name = "licence",
           .kind = Kind::text,
           .help = "of these numbers, as SPDX names it (CC-BY-4.0): for --crate"},
          {.name = "slump_flow_0",
           .dimension = Dimension::length,
           .range = positive,
           .help = "measured without rest: dashed in the chart, not used by the run"},
          {.name = "slump_flow_240",
           .dimension = Dimension::length,
           .range = positive,
           .help = "measured after 240 s of rest"},
          {.name = "slump_flow_tolerance",
           .dimension = Dimension::length,
           .range = not_negative,
           .help = "of the measured slump flows"},
          {.name = "measured_on",
           .kind = Kind::text,
           .help = "concrete on which slump_flow_0 and slump_flow_240 were measured, if not this one"},
          {.name = "friction_coefficient",
           .kind = Kind::number,
           .range = between(0.0, 10.0),
           .help = "of this concrete on the plate: the default of floor.coefficient"},
      }};
  const std::vector<Key> viscosity = viscosity_keys();
  section.keys.insert(section.keys.begin() + 1, viscosity.begin(), viscosity.end());
  return section;
}

/// K by youngs_modulus and poisson_ratio, or as given; the later layer wins.
void settle_bulk_modulus(Values& values) {
  const char *K = "mix.bulk_modulus", *E = "mix.youngs_modulus", *nu = "mix.poisson_ratio";
  if (!values.has(E) && !values.has(nu)) return;
  if (!values.has(E)) values.fail(nu, "needs youngs_modulus beside it, like youngs_modulus = \"0.01 MPa\"");
  if (!values.has(nu)) values.fail(E, "needs poisson_ratio beside it, like poisson_ratio = 0.45");
  const Layer layer = std::max(values.layer(E), values.layer(nu));
  if (values.given(K) && values.layer(K) == layer)
    values.fail(K, "is given beside youngs_modulus and poisson_ratio; give one or the other");
  if (!values.given(K) || values.layer(K) < layer) {
    constexpr double most = 1e13;  // of any pressure that a scene gives [Pa]
    if (const double by_ratio = bulk_modulus(values.number(E), values.number(nu)); by_ratio > most)
      values.fail(nu,
                  fmt::format("makes a bulk modulus of {:.3g} Pa; allowed: at most {:g} Pa", by_ratio, most));
    values.set_number(
        K, bulk_modulus(values.number(E), values.number(nu)), layer,
        fmt::format("from youngs_modulus = {} and poisson_ratio = {}",
                    write_quantity(values.number(E), Dimension::pressure), write_number(values.number(nu))));
  }
  values.drop(E);
  values.drop(nu);
}

constexpr const char* shear_modulus_key = "mix.shear_modulus";

void check_shear_modulus(const Values& values, bool elastic) {
  if (!elastic)
    values.fail(
        shear_modulus_key,
        "is known to apparatus = \"cell\" alone: a flow takes concrete below its yield stress for rigid; "
        "leave it out here");
  if (values.word("model.yield") != ExactBingham::word)
    values.fail(shear_modulus_key,
                "stands beside model.yield = \"" + values.word("model.yield") +
                    "\", by which concrete flows below its yield stress; allowed beside it: \"" +
                    std::string(ExactBingham::word) + "\"");
}

}  // namespace

Schema mix_sections(const std::string& bulk_modulus) {
  return {material_section(bulk_modulus), thixotropy_section()};
}

void settle_mix(Values& values) { settle_mix_with(values, {}); }

void settle_mix_with(Values& values, const MixAbilities& can) {
  settle_bulk_modulus(values);
  settle_law(values);
  settle_thixotropy(values, can.layer);
  if (values.has(shear_modulus_key)) check_shear_modulus(values, can.elastic);
}

Mix read_mix(const Values& values) {
  Mix mix;
  mix.density = values.number("mix.density");
  mix.tau_0 = values.number("mix.yield_stress");
  mix.mu = values.has("mix.plastic_viscosity") ? values.number("mix.plastic_viscosity")
                                               : newtonian(read_law(values));
  mix.K = values.number("mix.bulk_modulus");
  if (values.has(shear_modulus_key)) mix.G = values.number(shear_modulus_key);
  mix.thixotropy = read_thixotropy(values);
  return mix;
}

Measured read_measured(const Values& values) {
  const auto text = [&](const char* key) { return values.has(key) ? values.word(key) : std::string{}; };
  const auto length = [&](const char* key) -> std::optional<double> {
    return values.has(key) ? std::optional(values.number(key)) : std::nullopt;
  };
  return {text("mix.name"),
          text("mix.source"),
          length("mix.slump_flow_0"),
          length("mix.slump_flow_240"),
          length("mix.slump_flow_tolerance").value_or(0.0),
          length("measured.spread"),
          length("measured.tolerance"),
          length("measured.t500"),
          text("mix.measured_on"),
          text("mix.licence")};
}

Key rest_key(const std::string& fallback, const std::string& help) {
  return {.name = "rest",
          .dimension = Dimension::time,
          .range = not_negative,
          .fallback = fallback,
          .help = help};
}

Key duration_key(const std::string& fallback, const std::string& help) {
  return {.name = "duration",
          .dimension = Dimension::time,
          .range = positive,
          .fallback = fallback,
          .help = help};
}

Key lift_key(const std::string& name, const std::string& fallback, const std::string& help) {
  return {.name = name,
          .dimension = Dimension::speed,
          .range = positive,
          .words = {"instant"},
          .fallback = fallback,
          .help = help};
}

void check_points(const Values& values, double points) {
  constexpr double most = 1e8;
  if (points > most)
    values.fail(
        "model.cell",
        fmt::format(
            "makes about {:.0e} points; allowed: at most {:.0e}, by larger cells or fewer points_per_cell",
            points, most));
}

Section measured_section() {
  return {.name = "measured",
          .help = "What was measured on the real concrete, for the verdict; not used by the run.",
          .keys = {{.name = "spread", .range = positive, .example = "590 mm", .help = "slump flow"},
                   {.name = "tolerance", .range = positive, .fallback = "30 mm", .help = "of the spread"},
                   {.name = "t500", .dimension = Dimension::time, .range = positive, .example = "2.5 s"}},
          .optional = true};
}

Section floor_section() {
  return {.name = "floor", .help = "What the concrete flows on.", .keys = contact_keys()};
}

void settle_floor(Values& values) {
  settle_interface(values, "floor");
  const char* coefficient = "floor.coefficient";
  if (!values.has(coefficient) || values.given(coefficient) || !values.has("mix.friction_coefficient"))
    return;
  values.set_number(coefficient, values.number("mix.friction_coefficient"),
                    values.layer("mix.friction_coefficient"), "the mix's friction_coefficient");
}

Floor read_floor(const Values& values) { return {read_wall_law(values, "floor")}; }

Section model_section(const std::vector<std::string>& spaces, const ModelDefaults& defaults) {
  Section section{
      .name = "model",
      .help = "How it is computed.",
      .keys = {
          {.name = "space",
           .kind = Kind::choice,
           .words = spaces,
           .fallback = spaces.front(),
           .help = defaults.space_help},
          {.name = "scheme", .kind = Kind::choice, .words = names(scheme_words), .fallback = "implicit"},
          {.name = "method",
           .kind = Kind::choice,
           .words = names(method_words),
           .fallback = "auto",
           .only_with = Condition{"scheme", {"implicit"}},
           .help = "for the yield"},
          {.name = "shape", .kind = Kind::choice, .words = names(shape_words), .fallback = "b_spline"},
          {.name = "pressure",
           .kind = Kind::choice,
           .words = names(pressure_words),
           .fallback = "cell",
           .only_with = Condition{"scheme", {"explicit", "explicit_usf"}},
           .help = "one divergence a cell, against locking, or one a point"},
          {.name = "precision",
           .kind = Kind::choice,
           .words = names(precision_words),
           .fallback = "double",
           .only_with = Condition{"scheme", {"explicit_usf"}},
           .help = "of the sums between points and grid and of the law; single with transfer = apic"},
          {.name = "transfer", .kind = Kind::choice, .words = names(transfer_words), .fallback = "apic"},
          {.name = "flip_blend",
           .kind = Kind::number,
           .range = between(0.0, 1.0),
           .fallback = "0.95",
           .only_with = Condition{"transfer", {"flip"}},
           .help = "share of FLIP"},
          {.name = "time_step",
           .dimension = Dimension::time,
           .range = positive,
           .words = {"auto"},
           .fallback = "auto"},
          {.name = "cell",
           .dimension = Dimension::length,
           .range = positive,
           .shape = Shape::one_or_two,
           .fallback = defaults.cell,
           .example = "5 mm",
           .varies = true,
           .help = defaults.cell_help},
          {.name = "points_per_cell",
           .kind = Kind::integer,
           .range = between(1, 64),
           .shape = Shape::one_or_two,
           .fallback = defaults.points_per_cell,
           .varies = true,
           .help = defaults.points_help},
      }};
  const std::vector<Key> law = law_model_keys();
  section.keys.insert(section.keys.begin() + 1, law.begin(), law.end());
  return section;
}

Model read_model(const Values& values) {
  Model model;
  model.space = values.choice("model.space", space_words);
  model.law = read_law(values);
  model.scheme = values.choice("model.scheme", scheme_words);
  if (values.has("model.method")) model.method = values.choice("model.method", method_words);
  model.shape = values.choice("model.shape", shape_words);
  if (values.has("model.pressure")) model.pressure = values.choice("model.pressure", pressure_words);
  if (values.has("model.precision")) model.precision = values.choice("model.precision", precision_words);
  model.transfer = values.choice("model.transfer", transfer_words);
  if (values.has("model.flip_blend")) model.flip_blend = values.number("model.flip_blend");
  model.time_step = values.number_unless("model.time_step", "auto");
  const auto cell = values.numbers("model.cell"), points = values.numbers("model.points_per_cell");
  model.cell = {cell.front(), cell.back()};
  model.points_per_cell = {static_cast<int>(points.front()), static_cast<int>(points.back())};
  return model;
}

Section output_section() {
  return {.name = "output",
          .help = "What is written beside the result.",
          .keys = {
              {.name = "frames",
               .kind = Kind::boolean,
               .fallback = "true",
               .help = "the points over time, for ParaView"},
              {.name = "frame_interval",
               .dimension = Dimension::time,
               .range = positive,
               .words = {"auto"},
               .fallback = "auto",
               .help = "auto: often while it flows fast, seldom later"},
              {.name = "checkpoint_interval",
               .dimension = Dimension::time,
               .range = not_negative,
               .words = {"never"},
               .fallback = "60 s",
               .help = "of wall time, between two checkpoints that `tremie resume` goes on from"},
          }};
}

Output read_output(const Values& values) {
  return {values.number_unless("output.frame_interval", "auto").value_or(0.0),
          values.boolean("output.frames"), values.number_unless("output.checkpoint_interval", "never")};
}

}  // namespace tremie::scene
