#include "apparatus/calibration/lab.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/input_error.hpp"

namespace tremie::calibration {
namespace {

using scene::complain;
using scene::Dimension;
using scene::Node;

/// A reading that may be measured: its key in LAB.toml and its name in summary.json.
struct Known {
  std::string key, result;
  std::optional<Dimension> dimension = {};  ///< none: a plain number
  double factor = 1.0;                      ///< from SI to the result's unit
  bool logarithmic = false;                 ///< times
  bool usual = false;                       ///< what a laboratory measures by the test, and a forecast names
};

struct UnitOfReading {
  std::string_view unit;
  Dimension dimension;
  double factor;  ///< from SI
};
constexpr UnitOfReading units_of_readings[] = {
    {"mm", Dimension::length, 1e3},      {"m", Dimension::length, 1.0},  {"s", Dimension::time, 1.0},
    {"mm/s", Dimension::speed, 1e3},     {"m/s", Dimension::speed, 1.0}, {"Pa", Dimension::pressure, 1.0},
    {"Pa.s", Dimension::viscosity, 1.0}, {"1/s", Dimension::rate, 1.0},  {"N.m", Dimension::torque, 1.0}};

/// Nothing for a row that has no unit and is not what a laboratory measures: a word, a yes or no.
std::optional<Known> known_of(const scene::Described& row) {
  Known known{.key = row.name, .result = row.name, .usual = row.measurable};
  const std::string unit = scene::unit_of(row.name);
  if (unit == "1") return row.measurable ? std::optional(known) : std::nullopt;
  for (const auto& [name, dimension, factor] : units_of_readings)
    if (unit == name) {
      known.key = scene::name_without_unit(row.name);
      known.dimension = dimension;
      known.factor = factor;
      known.logarithmic = unit == "s";
      return known;
    }
  return std::nullopt;
}

/// What a laboratory may have measured by an apparatus: its results of one number; empty for one that there is not.
std::vector<Known> known_readings(const std::string& name) {
  std::vector<Known> known;
  for (const scene::Apparatus& apparatus : scene::all_apparatus())
    if (apparatus.keys.name == name)
      for (const scene::Described& row : apparatus.glossary)
        if (row.is_result && row.name.find('.') == std::string::npos)
          if (const auto reading = known_of(row)) known.push_back(*reading);
  return known;
}

/// Those that a laboratory usually measures.
std::vector<Known> usual_readings(const std::string& name) {
  std::vector<Known> usual;
  for (const Known& known : known_readings(name))
    if (known.usual) usual.push_back(known);
  return usual;
}

/// Whether the test ends when its concrete rests.
bool comes_to_rest(const std::string& name) {
  for (const scene::Apparatus& apparatus : scene::all_apparatus())
    if (apparatus.keys.name == name)
      for (const scene::Section& section : apparatus.keys.schema)
        if (section.name == "test")
          for (const scene::Key& key : section.keys)
            if (key.name == "rest_tolerance") return true;
  return false;
}

/// The apparatus by which something can be measured.
std::string measuring_apparatus() {
  std::vector<std::string> names;
  for (const scene::Apparatus& apparatus : scene::all_apparatus())
    if (!usual_readings(apparatus.keys.name).empty()) names.push_back(apparatus.keys.name);
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

const scene::Table& table_of(const Node& node, const std::string& key) {
  const auto* table = std::get_if<scene::Table>(&node.value);
  if (!table) complain(node, key, "must be a table");
  return *table;
}

std::string text_of(const Node& node, const std::string& key) {
  if (const auto* text = std::get_if<std::string>(&node.value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&node.value)) return scene::write_number(*number);
  if (const auto* truth = std::get_if<bool>(&node.value)) return *truth ? "true" : "false";
  complain(node, key, "must be one value");
}

/// As --set takes it: a list ("model.cell") keeps its brackets.
std::string override_text(const Node& node, const std::string& key) {
  const auto* list = std::get_if<scene::Array>(&node.value);
  if (!list) return text_of(node, key);
  std::string text;
  for (const Node& item : *list) {
    const bool quoted = std::holds_alternative<std::string>(item.value);
    text += (text.empty() ? "" : ", ") + (quoted ? '"' + text_of(item, key) + '"' : text_of(item, key));
  }
  return "[" + text + "]";
}

double quantity(const Node& node, const std::string& key, const Known& known) {
  const auto text = std::get_if<std::string>(&node.value);
  double value = 0.0;
  if (known.dimension) {
    if (!text) complain(node, key, "needs a unit, as a string: \"590 mm\", \"2.5 s\"");
    try {
      value = scene::parse_quantity(*text, *known.dimension) * known.factor;
    } catch (const std::invalid_argument& error) {
      complain(node, key, error.what());
    }
  } else if (const auto* number = std::get_if<double>(&node.value)) {
    value = *number;
  } else if (const auto* whole = std::get_if<std::int64_t>(&node.value)) {
    value = static_cast<double>(*whole);
  } else {
    complain(node, key, "must be a plain number");
  }
  if (!(value > 0.0) || std::isinf(value)) complain(node, key, "must be greater than 0 and finite");
  return value;
}

void read_measurement(const Node& table, const Known& known, Test& test) {
  const std::string& key = known.key;
  const Node* value = scene::find(table, key);
  const Node* error = scene::find(table, key + "_error");
  if (!value && error) complain(*error, key + "_error", "there is no " + key);
  if (!value) return;
  if (!error) complain(*value, key, fmt::format("needs its standard error: {}_error = \"…\"", key));
  test.readings.push_back({key, known.result, quantity(*value, key, known),
                           quantity(*error, key + "_error", known), known.logarithmic});
}

bool is_reading(const std::string& key, const std::string& apparatus) {
  const auto readings = known_readings(apparatus);
  return std::any_of(readings.begin(), readings.end(),
                     [&](const Known& k) { return key == k.key || key == k.key + "_error"; });
}

std::string readings_text(const std::string& apparatus) {
  std::string text;
  for (const Known& known : usual_readings(apparatus)) text += (text.empty() ? "" : ", ") + known.key;
  return text + " or another of its results (docs/reference/results.md)";
}

/// The apparatus and what the test's own keys say, for people.
std::string words_of(const Test& test) {
  std::string words = test.apparatus;
  std::replace(words.begin(), words.end(), '_', ' ');
  for (std::string key : test.overrides) {
    if (key.starts_with("test.")) key.erase(0, 5);
    std::erase(key, '"');
    std::replace(key.begin(), key.end(), '_', ' ');
    if (const std::size_t equal = key.find('='); equal != std::string::npos) key.replace(equal, 1, " = ");
    words += ", " + key;
  }
  return words;
}

/// A key of [test], of another section by its dotted name, or a section taken from a file; the concrete is what is sought.
std::string full_key(const std::string& key) {
  const bool is_full = key.find('.') != std::string::npos || (key != "mix" && scene::may_be_named(key));
  return is_full ? key : "test." + key;
}

/// [[measured]] or [[forecast]]: readings, and keys of the test (full_key).
Test read_test(const Node& node, const std::string& label, bool measured) {
  Test test{label, {}, {}, {}, {}};
  const Node* apparatus = scene::find(node, "apparatus");
  if (!apparatus) complain(node, label, "missing key apparatus");
  test.apparatus = text_of(*apparatus, "apparatus");
  if (usual_readings(test.apparatus).empty())
    complain(*apparatus, "apparatus", "must be " + measuring_apparatus());
  for (const auto& [key, value] : table_of(node, label)) {
    if (key == "apparatus" || is_reading(key, test.apparatus)) continue;
    test.overrides.push_back(full_key(key) + "=" + override_text(value, key));
  }
  test.words = words_of(test);
  if (comes_to_rest(test.apparatus) && !scene::find(node, "duration") && !scene::find(node, "test.duration"))
    test.overrides.push_back(until_it_rests);
  for (const Known& known : known_readings(test.apparatus)) {
    if (measured)
      read_measurement(node, known, test);
    else if (known.usual)
      test.readings.push_back({known.key, known.result, 0.0, 0.0, known.logarithmic});
  }
  if (test.readings.empty())
    complain(node, label, "nothing is measured; allowed: " + readings_text(test.apparatus));
  return test;
}

void read_tests(const Node& document, const char* name, Lab& lab) {
  const Node* list = scene::find(document, name);
  if (!list) return;
  const auto* tests = std::get_if<scene::Array>(&list->value);
  if (!tests) complain(*list, name, fmt::format("must be [[{}]]", name));
  for (std::size_t i = 0; i < tests->size(); ++i)
    lab.tests.push_back(
        read_test((*tests)[i], fmt::format("{}[{}]", name, i), std::string(name) == "measured"));
}

/// Log scale where the range spans a factor of five or more.
study::Scale scale_of(const Node& range) {
  const auto* ends = std::get_if<scene::Array>(&range.value);
  if (!ends || ends->size() != 2) return study::Scale::linear;
  try {
    const double low = std::stod(text_of((*ends)[0], "")), high = std::stod(text_of((*ends)[1], ""));
    return low > 0.0 && high >= 5.0 * low ? study::Scale::log : study::Scale::linear;
  } catch (const std::exception&) {
    return study::Scale::linear;
  }
}

/// The keys that the scene of the first test may have.
scene::Schema schema_of(const Lab& lab, const scene::Table& unknown) {
  std::vector<std::string> overrides = lab.known;
  overrides.insert(overrides.end(), lab.tests.front().overrides.begin(), lab.tests.front().overrides.end());
  for (const auto& [key, range] : unknown) {
    const auto* ends = std::get_if<scene::Array>(&range.value);
    if (!ends || ends->size() != 2) complain(range, key, "must be [low, high]");
    overrides.push_back(key + "=" + text_of(ends->front(), key));
  }
  const std::string text = fmt::format("apparatus = \"{}\"\n", lab.tests.front().apparatus);
  return scene::load({lab.file, overrides, text}, scene::all_keys()).schema;
}

void read_known(const Node& document, Lab& lab) {
  const Node* known = scene::find(document, "known");
  if (!known) return;
  for (const auto& [key, value] : table_of(*known, "known"))
    lab.known.push_back(key + "=" + override_text(value, key));
}

void read_unknowns(const Node& document, Lab& lab) {
  const Node* unknown = scene::find(document, "unknown");
  if (!unknown) complain(document, "unknown", "missing table [unknown], with a range for each key");
  const auto& table = table_of(*unknown, "unknown");
  if (table.empty()) complain(*unknown, "unknown", "needs at least one key");
  const auto schema = schema_of(lab, table);
  const Node* known = scene::find(document, "known");
  for (const auto& [key, range] : table)
    if (known && scene::find(*known, key))
      complain(range, key, "is in [known], too; allowed: in one of both");
  for (const auto& [key, range] : table)
    lab.unknowns.push_back(study::read_factor(key, range, true, scale_of(range), schema));
}

}  // namespace

Lab read_lab(const std::filesystem::path& file) {
  const Node document = scene::parse_file(file);
  const std::vector<std::string> allowed{"measured", "unknown", "known", "forecast"};
  for (const auto& [key, node] : table_of(document, file.string()))
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end())
      complain(node, key,
               fmt::format("unknown key; allowed: {}{}", fmt::join(allowed, ", "),
                           scene::nearest_in_brackets(key, allowed, "")));
  Lab lab;
  lab.name = file.stem().string();
  lab.file = file;
  read_tests(document, "measured", lab);
  lab.measured = lab.tests.size();
  if (lab.measured == 0) complain(document, "measured", "needs at least one [[measured]]");
  read_known(document, lab);
  read_unknowns(document, lab);
  read_tests(document, "forecast", lab);
  // Every test's scene is read once, at the middle of the ranges, before anything is run.
  lab.files.push_back(file);
  for (const Test& test : lab.tests) {
    const auto scene = scene_at(lab, test, std::vector<double>(lab.unknowns.size(), 0.5));
    lab.files.insert(lab.files.end(), scene.files.begin(), scene.files.end());
  }
  return lab;
}

scene::Scene scene_at(const Lab& lab, const Test& test, const std::vector<double>& shares) {
  std::vector<std::string> overrides = lab.known;
  overrides.insert(overrides.end(), test.overrides.begin(), test.overrides.end());
  for (std::size_t i = 0; i < shares.size(); ++i)
    overrides.push_back(lab.unknowns[i].key + "=" + study::level_at(lab.unknowns[i], shares[i]).text);
  return scene::read_text(fmt::format("apparatus = \"{}\"\n", test.apparatus), lab.file.string(), overrides);
}

}  // namespace tremie::calibration
