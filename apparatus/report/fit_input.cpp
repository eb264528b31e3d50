#include "apparatus/report/fit_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>

#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::report {
namespace {

using Json = nlohmann::ordered_json;

/// [rad/(N m)]
double compliance_of(const std::string& text) {
  std::size_t used = 0;
  double value = -1.0;
  try {
    value = std::stod(text, &used);
  } catch (const std::logic_error&) {  // no number: refused below
  }
  std::string unit = text.substr(used);
  std::erase(unit, ' ');
  if (!(value >= 0.0) || !std::isfinite(value) || unit != "rad/(N.m)")
    throw std::invalid_argument(fmt::format("\"{}\" is no compliance; write \"0.02 rad/(N.m)\"", text));
  return value;
}

double si_value(const FitOption& option, const std::string& text) {
  if (option.is_flag()) throw std::invalid_argument(fmt::format("\"{}\" is neither true nor false", text));
  if (option.unit == "rad/(N.m)") return compliance_of(text);
  const double value = scene::parse_quantity(text, scene::dimension_of(option.unit));
  if (option.range == OptionRange::positive && !(value > 0.0))
    throw std::invalid_argument(fmt::format("\"{}\" is not greater than 0", text));
  return value;
}

}  // namespace

std::string command_name(const FitOption& option) {
  std::string name = "--" + option.name;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

void read_option(FitOptions& options, const FitOption& option, const std::string& name,
                 const std::string& text) {
  try {
    if (option.is_word())
      set_option(options, option, text);
    else
      set_option(options, option, si_value(option, text));
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(fmt::format("{}: {}", name, error.what()));
  }
}

std::string fit_command(const std::vector<std::string>& records, const std::vector<std::string>& texts) {
  const FitOptions unset;
  std::string values, flags;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const FitOption& option = fit_options()[i];
    if (texts[i].empty()) continue;
    if (option.is_flag())
      flags += " " + command_name(option);
    else if (!option.is_word() || texts[i] != unset.*std::get<std::string FitOptions::*>(option.member))
      values += fmt::format(" {} '{}'", command_name(option), texts[i]);
  }
  return fmt::format("tremie fit {}{}{}", fmt::join(records, " "), values, flags);
}

Json fit_input(const FitOptions& options, const std::vector<std::string>& records) {
  std::map<int, const FitOption*> rows;
  for (const FitOption& option : fit_options())
    if (option.input.place > 0) rows[option.input.place] = &option;
  Json json{{"record", records.size() == 1 ? Json(records.front()) : Json(records)}};
  for (const auto& entry : rows) {
    const FitOption* option = entry.second;
    const auto in_its_unit = [&](double value) {
      return value * option->input.factor / option->input.divisor;
    };
    json[option->input.key] = std::visit(
        [&](auto member) -> Json {
          const auto& value = options.*member;
          if constexpr (std::is_same_v<decltype(value), const double&>)
            return in_its_unit(value);
          else if constexpr (std::is_same_v<decltype(value), const std::optional<double>&>)
            return value ? Json(in_its_unit(*value)) : Json(nullptr);
          else
            return value;
        },
        option->member);
  }
  return json;
}

}  // namespace tremie::report
