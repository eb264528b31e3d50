#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "apparatus/scene/input_error.hpp"
#include "apparatus/study/definition.hpp"

namespace tremie::study {
namespace {

using scene::complain;
using scene::Key;
using scene::Kind;

std::vector<std::string> all_names(const scene::Schema& schema) {
  std::vector<std::string> names;
  for (const auto& section : schema)
    if (!section.repeated && !section.name.empty())
      for (const auto& key : section.keys) names.push_back(section.name + "." + key.name);
  return names;
}

Key key_named(const std::string& key, const scene::Node& at, const scene::Schema& schema) {
  const auto dot = key.rfind('.');
  const std::string table = dot == std::string::npos ? "" : key.substr(0, dot);
  const auto bracket = table.find('[');  // of "load[1]", a table of a list
  const auto* section = table.empty() ? nullptr : scene::find_section(schema, table.substr(0, bracket));
  const bool as_it_is = section && section->repeated == (bracket != std::string::npos);
  const auto* found = as_it_is ? scene::find_key(*section, key.substr(dot + 1)) : nullptr;
  if (!found)
    complain(
        at, key,
        fmt::format("the scene has no such key{}", scene::nearest_in_brackets(key, all_names(schema), "")));
  return *found;
}

std::string text_of(double number, const Key& about) {
  if (about.kind == Kind::quantity) return scene::write_quantity(number, about.dimension);
  if (about.kind == Kind::integer) return fmt::format("{:.0f}", number);
  return scene::write_number(number);
}

double number_in_si(const scene::Node& node, const std::string& key, const Key& about) {
  if (const auto* text = std::get_if<std::string>(&node.value)) {
    if (about.kind != Kind::quantity) complain(node, key, "\"" + *text + "\" is a string; write a number");
    try {
      return scene::parse_quantity(*text, about.dimension);
    } catch (const std::invalid_argument& error) {
      complain(node, key, error.what());
    }
  }
  double number = 0.0;
  if (const auto* whole = std::get_if<std::int64_t>(&node.value))
    number = static_cast<double>(*whole);
  else if (const auto* real = std::get_if<double>(&node.value))
    number = *real;
  else
    complain(node, key, "must be a number, or a quantity as a string");
  if (about.kind == Kind::quantity)
    complain(
        node, key,
        fmt::format("{0} is a bare number; write it with a unit: \"{1}\" (units: {2})",
                    scene::write_number(number), text_of(number, about), scene::units_text(about.dimension)));
  return number;
}

void check_range(const scene::Node& node, const std::string& key, const Key& about, double number) {
  if (!std::isfinite(number) || !scene::contains(about.range, number))
    complain(
        node, key,
        fmt::format("{} is out of range; it must be {}", text_of(number, about), scene::range_text(about)));
}

bool is_word(const Key& about, const scene::Node& node) {
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text) return false;
  if (about.kind == Kind::choice || about.kind == Kind::text) return true;
  return std::find(about.words.begin(), about.words.end(), *text) != about.words.end();
}

Level read_level(const std::string& key, const scene::Node& node, const Key& about) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (const auto* flag = std::get_if<bool>(&node.value); flag && about.kind == Kind::boolean)
    return {none, *flag ? "true" : "false"};
  if (is_word(about, node)) {
    const auto& word = std::get<std::string>(node.value);
    const auto& allowed = about.words;
    if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), word) == allowed.end())
      complain(node, key,
               fmt::format("\"{}\" is not allowed{}", word, scene::nearest_in_brackets(word, allowed)));
    return {none, word};
  }
  const double number = number_in_si(node, key, about);
  check_range(node, key, about, number);
  return {number, text_of(number, about)};
}

void read_range(const scene::Node& range, Factor& factor) {
  const auto* ends = std::get_if<scene::Array>(&range.value);
  if (!ends || ends->size() != 2) complain(range, factor.key, "range must be two values, [low, high]");
  if (factor.about.kind == Kind::choice || factor.about.kind == Kind::text ||
      factor.about.kind == Kind::boolean)
    complain(range, factor.key, "takes words; give values = [...] in place of a range");
  factor.low = number_in_si((*ends)[0], factor.key, factor.about);
  factor.high = number_in_si((*ends)[1], factor.key, factor.about);
  check_range((*ends)[0], factor.key, factor.about, factor.low);
  check_range((*ends)[1], factor.key, factor.about, factor.high);
  if (!(factor.low < factor.high))
    complain(range, factor.key, "the low end of the range must be less than the high end");
  if (factor.scale == Scale::log && !(factor.low > 0.0))
    complain(range, factor.key, "a log scale needs a range above 0");
}

void read_values(const scene::Node& values, Factor& factor) {
  const auto* list = std::get_if<scene::Array>(&values.value);
  if (!list || list->empty()) complain(values, factor.key, "values must be an array of at least one");
  for (const auto& node : *list) factor.values.push_back(read_level(factor.key, node, factor.about));
}

}  // namespace

Factor read_factor(const std::string& key, const scene::Node& range, bool is_range, Scale scale,
                   const scene::Schema& schema) {
  Factor factor;
  factor.key = key;
  factor.about = key_named(key, range, schema);
  factor.scale = scale;
  is_range ? read_range(range, factor) : read_values(range, factor);
  return factor;
}

std::string unit_of(const Factor& factor) {
  if (factor.about.kind != Kind::quantity) return "";
  return std::string(scene::units(factor.about.dimension).front().name);
}

std::string column_of(const Factor& factor) {
  std::string unit;
  for (const char c : unit_of(factor)) {
    if (c == '/')
      unit += unit.empty() || unit == "1" ? "per_" : "_per_";
    else
      unit += c == '.' || c == '^' ? '_' : c;
  }
  if (unit.starts_with("1per_")) unit.erase(0, 1);
  return unit.empty() ? factor.key : factor.key + "_" + unit;
}

Level level_at(const Factor& factor, double share) {
  if (!factor.values.empty()) {
    const auto n = factor.values.size();
    return factor.values[std::min(n - 1, static_cast<std::size_t>(share * static_cast<double>(n)))];
  }
  double number = factor.low + share * (factor.high - factor.low);
  if (factor.scale == Scale::log) number = factor.low * std::pow(factor.high / factor.low, share);
  number = std::clamp(number, factor.low, factor.high);
  if (factor.about.kind == Kind::integer) number = std::round(number);
  return {number, text_of(number, factor.about)};
}

double share_of(const Factor& factor, double number) {
  if (factor.scale == Scale::log) return std::log(number / factor.low) / std::log(factor.high / factor.low);
  return (number - factor.low) / (factor.high - factor.low);
}

}  // namespace tremie::study
