#include "apparatus/registry/usual_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "libmpm/constitutive/constants.hpp"

namespace tremie::scene {
namespace {

constexpr const char* rheographs = "Wallevik and Wallevik 2011, rheographs of pastes to stiff concretes";
constexpr const char* rheometers =
    "Ferraris and Brower 2001, five concrete rheometers; Koehler and Fowler 2004, ICAR";
constexpr const char* moulds = "EN 12350-2 and -8, EN 1015-3, ASTM C230, mini cones of 57 mm";
constexpr const char* l_boxes = "EN 12350-10 and boxes of half and twice its size";
constexpr const char* densities = "EN 206 and ACI 523.3R, from foamed to heavyweight concrete";
constexpr const char* structuration =
    "Roussel 2006: 0.5 Pa/s is highly thixotropic; to 2.9 in the paper's mixes";
constexpr const char* waiting = "from a second to the end of workability, EFFC/DFI 2018";
constexpr const char* readings = "EN 12350-8 and mini cones";

/// Key, lowest and highest, source.
const std::vector<UsualRange> table{
    {"mix.yield_stress", 0.1, 5e3, rheographs},
    {"mix.plastic_viscosity", 0.1, 1e3, rheographs},
    {"mix.consistency", 0.1, 1e3, rheographs},
    {"mix.density", 300.0, 7e3, densities},
    {"mix.thixotropy.structuration_rate", 1e-3, 20.0, structuration},
    {"mix.slump_flow_0", 0.08, 1.1, readings},
    {"mix.slump_flow_240", 0.08, 1.1, readings},
    {"cone.top_radius", 5e-3, 0.15, moulds},
    {"cone.bottom_radius", 10e-3, 0.2, moulds},
    {"cone.height", 40e-3, 0.6, moulds},
    {"ring.diameter", 0.1, 0.6, "EN 12350-12 and rings of half and twice its size"},
    {"ring.bar_diameter", 5e-3, 40e-3, "EN 12350-12 and rings of half and twice its size"},
    {"test.lift_speed", 0.02, 1.0, "EN 12350-8 and ASTM C143: 300 mm in 1 to 7 s"},
    {"test.gate_speed", 0.02, 2.0, "EN 12350-10: one smooth movement"},
    {"test.rest", 1.0, 7200.0, waiting},
    {"measured.spread", 0.08, 1.1, readings},
    {"measured.t500", 0.1, 60.0, readings},
    {"box.column_length", 40e-3, 0.3, l_boxes},
    {"box.column_height", 0.25, 1.5, l_boxes},
    {"box.channel_length", 0.25, 2.0, l_boxes},
    {"box.channel_height", 50e-3, 0.4, l_boxes},
    {"box.width", 80e-3, 0.6, l_boxes},
    {"vane.radius", 5e-3, 0.4, rheometers},
    {"vane.height", 10e-3, 1.0, rheometers},
    {"vane.container_radius", 10e-3, 0.7, rheometers},
    {"vane.blade_thickness", 3e-4, 20e-3, rheometers},
    {"vane.shaft_radius", 1e-3, 50e-3, rheometers},
    {"vane.bottom_gap", 1e-3, 0.5, rheometers},
    {"vane.cover", 1e-3, 0.5, rheometers},
    {"test.speed", 1e-3 * two_pi, 3.0 * two_pi, rheometers},
    {"test.speeds", 1e-3 * two_pi, 3.0 * two_pi, rheometers},
    {"test.pre_shear_speed", 1e-3 * two_pi, 3.0 * two_pi, rheometers},
};

bool is_usual(const UsualRange& range, double value) {
  const double size = std::abs(value);
  return size == 0.0 || (size >= range.low && size <= range.high);
}

/// "54 kPa" in this unit.
std::string written_in(const Unit& unit, double value) {
  return fmt::format("{:.4g} {}", value * unit.denominator / unit.numerator, unit.name);
}

/// The unit that was written: of those the one that gives back the text.
const Unit* unit_of(const std::string& text, std::span<const Unit> units) {
  const Unit* found = nullptr;
  for (const Unit& unit : units)
    if (text.ends_with(unit.name) && (!found || unit.name.size() > found->name.size())) found = &unit;
  return found;
}

/// ": is kPa written for Pa?", where one other unit alone brings the number into the range.
std::string slip(const UsualRange& range, double value, const std::string& text,
                 std::span<const Unit> units) {
  const Unit* written = unit_of(text, units);
  if (!written) return {};
  const double number = value * written->denominator / written->numerator;
  for (const Unit& unit : units)
    if (is_usual(range, number * unit.numerator / unit.denominator))
      return fmt::format("; {} may stand for {}", written->name, unit.name);
  return {};
}

/// What stands in an apparatus at the start.
constexpr const char* heights[] = {"cone.height", "box.column_height", "box.height"};

}  // namespace

const std::vector<UsualRange>& usual_ranges() { return table; }

std::vector<std::string> unusual_values(const Schema& schema, const Values& values) {
  std::vector<std::string> notes;
  for (const UsualRange& range : table) {
    if (!values.has(range.key) || !values.given(range.key)) continue;
    const std::string_view name = range.key;
    const auto dot = name.rfind('.');
    const Key* key = find_key(*find_section(schema, name.substr(0, dot)), name.substr(dot + 1));
    const Value& value = values.at(name);
    for (std::size_t i = 0; i < value.numbers.size(); ++i) {
      if (is_usual(range, value.numbers[i])) continue;
      const auto all = units(key->dimension);
      const std::string text =
          i < value.written.size() ? value.written[i] : write_quantity(value.numbers[i], key->dimension);
      notes.push_back(fmt::format("{}: {}: {} is unusual: {} to {} are usual ({}){}", describe(value.origin),
                                  name, text, written_in(all.front(), range.low),
                                  written_in(all.front(), range.high), range.source,
                                  slip(range, value.numbers[i], text, all)));
      break;
    }
  }
  return notes;
}

std::string softness(const Values& values) {
  constexpr double most = 0.02, gravity = 9.81;
  for (const char* height : heights) {
    if (!values.has(height) || !values.has("mix.bulk_modulus")) continue;
    const double K = values.number("mix.bulk_modulus"), h = values.number(height);
    const double weight = values.number("mix.density") * gravity * h, lost = -std::expm1(-weight / K);
    if (!(lost > most)) return {};
    return fmt::format(
        "mix.bulk_modulus: {} kPa is soft: {} m of concrete exert {} kPa and compress the foot by {} %; "
        "{} kPa limits this to 1 %",
        rounded(1e-3 * K, 3), rounded(h, 3), rounded(1e-3 * weight, 3), rounded(100.0 * lost, 2),
        rounded(0.1 * weight, 1));
  }
  return {};
}

}  // namespace tremie::scene
