#include "rheometer/whole_fit/fit_options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "libmpm/constitutive/constants.hpp"
#include "rheometer/fits/flow_law.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {
namespace {

std::vector<std::string> words_of_laws() {
  std::vector<std::string> words{"auto"};
  for (const FlowLaw& law : flow_laws()) words.push_back(law.name);
  return words;
}

std::vector<std::string> words_of_kinetics() {
  std::vector<std::string> words = kinetics_words();
  words.insert(words.begin(), "auto");
  return words;
}

void require(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument(what);
}

using Text = const char*;

FitOption number(Text name, FitOption::Member member, Text unit, Text help, FitOption::Input input = {},
                 OptionRange range = OptionRange::positive) {
  return {name, member, unit, help, input, {}, range};
}

FitOption word(Text name, FitOption::Member member, const std::vector<std::string>& words, Text help,
               FitOption::Input input) {
  return {name, member, "", help, input, words};
}

FitOption text(Text name, FitOption::Member member, Text help, FitOption::Input input) {
  return {name, member, "", help, input};
}

FitOption flag(Text name, FitOption::Member member, Text help) { return {name, member, "", help}; }

}  // namespace

const std::vector<FitOption>& fit_options() {
  using O = FitOptions;
  static const std::vector<FitOption> all{
      number("vane_radius", &O::vane_radius, "m", "Radius of the vane (default: \"63.5 mm\", ICAR)",
             {1, "vane_radius_mm", 1e3}),
      number("vane_height", &O::vane_height, "m", "Height of the vane (default: \"127 mm\", ICAR)",
             {2, "vane_height_mm", 1e3}),
      number("container_radius", &O::container_radius, "m",
             "Radius of the container (default: \"143 mm\", ICAR)", {3, "container_radius_mm", 1e3}),
      number("speed", &O::speed, "rad/s", "Speed of a torque decay: \"0.25 rev/s\"",
             {4, "speed_rev_per_s", 1.0, two_pi}),
      number("rest", &O::rest, "s", "Rest before a torque decay: \"240 s\"", {5, "rest_s"}),
      number("yield_stress", &O::yield_stress, "Pa", "Dynamic yield stress, if known: \"54 Pa\"",
             {6, "yield_stress_Pa"}),
      number("plastic_viscosity", &O::plastic_viscosity, "Pa.s", "Plastic viscosity, if known: \"35.8 Pa.s\"",
             {7, "plastic_viscosity_Pa_s"}),
      word("kinetics", &O::kinetics, words_of_kinetics(),
           "Kinetics of the flocculation state (default: auto)", {8, "kinetics"}),
      word("law", &O::law, words_of_laws(),
           "Law of a flow curve (default: bingham; with --protocol auto); auto: both are compared",
           {9, "law"}),
      number("critical_shear_rate", &O::critical_shear_rate, "1/s",
             "Critical shear rate of the gated kinetics (default: \"0.1 1/s\")",
             {13, "critical_shear_rate_per_s"}),
      flag("protocol", &O::protocol, "Read every section of a record with time, speed and torque"),
      flag("elastic", &O::elastic,
           "With --protocol: fit k and a to plastic shear rates, for material that is elastic below its "
           "yield stress"),
      number("instrument_compliance", &O::instrument_compliance, "rad/(N.m)",
             "Rotation of the instrument by its own torque: \"0.02 rad/(N.m)\"", {},
             OptionRange::not_negative),
      number("torque_offset", &O::torque_offset, "N.m",
             "Torque of the unloaded instrument, to be subtracted: \"0.3 mN.m\"", {12, "torque_offset_N_m"},
             OptionRange::any),
      word("ends", &O::ends, {"none", "textbook", "computed"}, "Torque on the ends of the vane",
           {10, "ends"}),
      word("blades", &O::blades, {"none", "computed"},
           "Torque of blades below that of their cylinder; add --ends computed for a real vane",
           {11, "blades"}),
      number("max_aggregate", &O::max_aggregate, "m", "Largest grain, to check the gap: \"16 mm\""),
      text("geometry", &O::geometry,
           "Geometry in place of the vane: a name of reference_data/geometries (fann_r1b1, cc27, ...), or "
           "\"cone_plate, 25 mm, 1 deg\", \"parallel_plates, 25 mm, 1 mm\", \"cylinders, R_i, R_o, height\", "
           "\"double_gap, R_1, R_2, R_3, R_4, height\", \"constants, Pa/(N.m), 1/s by rad/s\"",
           {14, "geometry"}),
      text("column", &O::column, "Columns with unknown names: \"torque=3; speed=Kanal 2 [rpm]\"",
           {15, "column"}),
      word("decimal", &O::decimal, {"auto", "point", "comma"}, "Decimal mark, if the numbers leave it open",
           {16, "decimal"}),
      text("table", &O::table, "Number of the table to read, in a file with several: \"2\"", {19, "table"}),
      number("torque_per_degree", &O::torque_per_degree, "N.m",
             "Torque of one dial degree: \"0.036379 mN.m\"", {17, "torque_per_degree_N_m"}),
      number("full_scale_torque", &O::full_scale_torque, "N.m",
             "Torque of 100 %, for readings in %: \"0.7187 mN.m\" (Brookfield RV)",
             {18, "full_scale_torque_N_m"}),
      flag("tribometer", &O::tribometer,
           "A smooth cylinder in place of the vane: the wall's interface law, for [walls] of a scene"),
      text("fill_height", &O::fill_height,
           "Tribometer: height of concrete along the cylinder in each record: \"100 mm; 150 mm\"",
           {20, "fill_height"}),
      word("smooth_wall", &O::smooth_wall, {"cylinder", "container"},
           "Tribometer: the wall along which the concrete slides; the other one is rough (default: cylinder)",
           {})};
  return all;
}

void set_option(FitOptions& options, const FitOption& option, double value) {
  const std::string text = text_of("%g", value);
  require(std::isfinite(value), text + " is no finite number");
  if (option.range == OptionRange::positive) require(value > 0.0, text + " is not greater than 0");
  if (option.range == OptionRange::not_negative) require(value >= 0.0, text + " is less than 0");
  if (const auto* member = std::get_if<double FitOptions::*>(&option.member))
    options.*(*member) = value;
  else if (const auto* optional = std::get_if<std::optional<double> FitOptions::*>(&option.member))
    options.*(*optional) = value;
  else
    require(false, text + " is a number; it takes none");
}

void set_option(FitOptions& options, const FitOption& option, const std::string& word) {
  std::string allowed;
  for (const std::string& w : option.words) allowed += (allowed.empty() ? "\"" : ", \"") + w + "\"";
  require(option.is_word(), "\"" + word + "\" is a text; it takes none");
  require(
      option.words.empty() || std::find(option.words.begin(), option.words.end(), word) != option.words.end(),
      "\"" + word + "\" is not allowed; allowed: " + allowed);
  options.*std::get<std::string FitOptions::*>(option.member) = word;
}

void set_option(FitOptions& options, const FitOption& option, bool flag) {
  require(option.is_flag(), "is no flag");
  options.*std::get<bool FitOptions::*>(option.member) = flag;
}

std::string law_of(const FitOptions& o) {
  if (!o.law.empty()) return o.law;
  return o.protocol && o.blades == "none" ? "auto" : flow_laws().front().name;
}

bool has_default_lengths(const FitOptions& o) {
  const Instrument usual;
  return o.vane_radius == usual.vane_radius && o.vane_height == usual.vane_height &&
         o.container_radius == usual.container_radius;
}

void check(const FitOptions& o) {
  if (!o.geometry.empty() && !has_default_lengths(o))
    throw std::invalid_argument("--geometry stands for the vane's lengths; give it or them, not both");
  check(Instrument{o.vane_radius, o.vane_height, o.container_radius});
  if (o.tribometer && (o.protocol || o.ends != "none" || o.blades != "none" || !o.geometry.empty()))
    throw std::invalid_argument(
        "--tribometer is a smooth cylinder's, by --vane-radius and --container-radius; not with --protocol, "
        "--ends, "
        "--blades or --geometry");
  if (o.elastic && !o.protocol)
    throw std::invalid_argument("--elastic is of the start-ups of a protocol: --protocol");
  if (!o.fill_height.empty() && !o.tribometer)
    throw std::invalid_argument("--fill-height is a tribometer's: --tribometer");
  if (o.smooth_wall != FitOptions{}.smooth_wall && !o.tribometer)
    throw std::invalid_argument("--smooth-wall is a tribometer's: --tribometer");
  if (o.blades != "none" && law_of(o) != flow_laws().front().name)
    throw std::invalid_argument(
        "--blades computed is for Bingham's law, of which its table is; not with --law " + o.law);
  if (o.protocol && o.plastic_viscosity && law_of(o) != "auto" &&
      !flow_law(law_of(o)).in_place_of_viscosity.empty())
    throw std::invalid_argument("--plastic-viscosity: " + flow_law(o.law).in_place_of_viscosity +
                                "; not with --law " + o.law);
}

FitInput input_of(const FitOptions& o) {
  FitInput in;
  in.instrument = {o.vane_radius, o.vane_height, o.container_radius};
  in.tau_0 = o.yield_stress;
  in.mu = o.plastic_viscosity;
  in.omega = o.speed;
  in.rest = o.rest;
  in.choose_kinetics = o.kinetics == "auto";
  in.kinetics = kinetics_named(o.kinetics).value_or(Kinetics{});
  in.max_aggregate = o.max_aggregate.value_or(0.0);
  in.law = law_of(o);
  in.law_given = !o.law.empty();
  in.gamma_c = o.critical_shear_rate;
  return in;
}

}  // namespace tremie
