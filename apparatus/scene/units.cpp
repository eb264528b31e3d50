#include "apparatus/scene/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "libmpm/constitutive/constants.hpp"
#include "rheometer/tables/number_text.hpp"

namespace tremie::scene {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// A unit and the numbers that are usual in it at a site or in a laboratory, up to the next.
struct Usual {
  std::string_view unit;
  double from = 0.0;
};

/// By ascending numbers.
std::vector<Usual> usual_units(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return {{"m"}, {"mm", 1.0}};
    case Dimension::speed:
      return {{"m/s"}, {"cm/s", 1.0}, {"mm/s", 100.0}};
    case Dimension::density:
      return {{"g/cm3"}, {"kg/m3", 100.0}};
    case Dimension::rotation:
      return {{"rev/s"}, {"rpm", 3.0}};
    case Dimension::angle:
      return {{"deg"}};
    case Dimension::flow:
      return {{"m3/h"}};
    case Dimension::torque:
      return {{"N.m"}, {"mN.m", 20.0}};
    default:
      return {{units(dimension).front().name}};
  }
}

double si_value(double number, const Unit& unit) { return number * unit.numerator / unit.denominator; }

struct Split {
  double number;
  std::string_view unit;
};

/// "54 Pa" as a number and the text after it; empty where no number leads.
std::optional<Split> split(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0.0;
  const std::size_t length = read_number(text, number);
  if (length == 0) return std::nullopt;
  return Split{number, trimmed(text.substr(length))};
}

}  // namespace

std::span<const Unit> units(Dimension dimension) {
  static const std::map<Dimension, std::vector<Unit>> all{
      {Dimension::length, {{"m"}, {"cm", 1, 100}, {"mm", 1, 1000}}},
      {Dimension::time, {{"s"}, {"ms", 1, 1000}, {"min", 60}, {"h", 3600}}},
      {Dimension::speed, {{"m/s"}, {"cm/s", 1, 100}, {"mm/s", 1, 1000}}},
      {Dimension::pressure, {{"Pa"}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}}},
      {Dimension::viscosity, {{"Pa.s"}, {"Pa·s"}, {"Pa s"}, {"mPa.s", 1, 1000}, {"mPa·s", 1, 1000}}},
      {Dimension::density, {{"kg/m3"}, {"kg/m³"}, {"kg/m^3"}, {"g/cm3", 1000}, {"t/m3", 1000}}},
      {Dimension::rate, {{"1/s"}, {"/s"}, {"s^-1"}, {"1/min", 1, 60}}},
      {Dimension::structuration, {{"Pa/s"}, {"Pa/min", 1, 60}, {"kPa/s", 1000}}},
      {Dimension::rotation, {{"rad/s"}, {"rev/s", two_pi}, {"rpm", two_pi, 60}}},
      {Dimension::angle, {{"rad"}, {"deg", std::numbers::pi, 180}, {"°", std::numbers::pi, 180}}},
      {Dimension::torque, {{"N.m"}, {"N·m"}, {"N m"}, {"mN.m", 1, 1000}, {"mN·m", 1, 1000}}},
      {Dimension::volume, {{"m3"}, {"m³"}, {"m^3"}, {"l", 1, 1000}}},
      {Dimension::flow,
       {{"m3/s"}, {"m³/s"}, {"m3/h", 1, 3600}, {"m³/h", 1, 3600}, {"l/s", 1, 1000}, {"l/min", 1, 60'000}}},
      {Dimension::consistency, {{"Pa.s^n"}, {"Pa·s^n"}, {"Pa s^n"}}},
      {Dimension::wall_drag, {{"Pa.s/m"}, {"Pa·s/m"}, {"Pa s/m"}, {"kPa.s/m", 1e3}}},
      {Dimension::acceleration, {{"m/s2"}, {"m/s²"}, {"m/s^2"}}}};
  const auto found = all.find(dimension);
  if (found == all.end()) throw std::logic_error("a dimension without units");
  return found->second;
}

Dimension dimension_of(std::string_view si_unit) {
  for (int i = 0; i <= static_cast<int>(Dimension::consistency); ++i)
    if (units(static_cast<Dimension>(i)).front().name == si_unit) return static_cast<Dimension>(i);
  throw std::logic_error("no dimension has the SI unit " + std::string(si_unit));
}

std::string units_text(Dimension dimension) {
  std::string text;
  for (const Unit& unit : units(dimension)) text += (text.empty() ? "" : ", ") + std::string(unit.name);
  return text;
}

std::string_view unit_meant(double number, Dimension dimension, const std::function<bool(double)>& allowed) {
  std::string_view usual;
  for (const Usual& u : usual_units(dimension))
    if (std::abs(number) >= u.from) usual = u.unit;
  const auto all = units(dimension);
  const auto fits = [&](const Unit& unit) { return !allowed || allowed(si_value(number, unit)); };
  const auto named = std::find_if(all.begin(), all.end(), [&](const Unit& u) { return u.name == usual; });
  if (fits(*named)) return usual;
  const auto other = std::find_if(all.begin(), all.end(), fits);
  return other == all.end() ? usual : other->name;
}

double parse_quantity(std::string_view text, Dimension dimension,
                      const std::function<bool(double)>& allowed_value) {
  const auto parts = split(text);
  const auto allowed = units_text(dimension);
  const auto si = units(dimension).front().name;
  if (!parts) {
    throw std::invalid_argument(
        fmt::format("\"{}\" does not start with a number that can be held; write a number and a unit, like "
                    "\"1.5 {}\" (units: {})",
                    text, si, allowed));
  }
  if (!std::isfinite(parts->number))
    throw std::invalid_argument(fmt::format("\"{}\" is not a finite number (units: {})", text, allowed));
  if (parts->unit.empty()) {
    throw std::invalid_argument(fmt::format("\"{0}\" has no unit; write \"{0} {1}\" (units: {2})",
                                            trimmed(text),
                                            unit_meant(parts->number, dimension, allowed_value), allowed));
  }
  for (const Unit& unit : units(dimension)) {
    if (parts->unit != unit.name) continue;
    const double value = si_value(parts->number, unit);
    if (!std::isfinite(value))
      throw std::invalid_argument(fmt::format("\"{}\" is too large to be held", text));
    return value;
  }
  if (parts->unit.size() > 1 && parts->unit[0] == ',' && parts->unit[1] >= '0' && parts->unit[1] <= '9') {
    std::string with_point(trimmed(text));
    with_point[with_point.find(',')] = '.';
    throw std::invalid_argument(fmt::format("\"{}\" has a decimal comma; write a point: \"{}\" (units: {})",
                                            text, with_point, allowed));
  }
  throw std::invalid_argument(
      fmt::format("\"{}\" has the wrong unit \"{}\"; allowed units: {}", text, parts->unit, allowed));
}

std::string write_number(double value) {
#ifndef __cpp_lib_to_chars
  return fmt::format("{}", value);  // as few digits as read back to the same number
#else
  const double size = std::abs(value);
  const bool plain = size == 0.0 || (size >= 1e-4 && size < 1e12);
  std::array<char, 64> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          plain ? std::chars_format::fixed : std::chars_format::scientific);
  return error == std::errc{} ? std::string(buffer.data(), end) : fmt::format("{}", value);
#endif
}

std::string rounded(double value, int digits) {
  const double size = std::abs(value);
  return size >= 1.0 && size < 1e7 && size >= std::pow(10.0, digits) - 0.5
             ? fmt::format("{:.0f}", value)
             : fmt::format("{:.{}g}", value, digits);
}

std::string write_quantity(double value, Dimension dimension) {
  return write_number(value) + " " + std::string(units(dimension).front().name);
}

std::string write_at_most(double value, Dimension dimension) {
  if (!(value > 0.0)) return write_quantity(value, dimension);
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 3.0);
  return rounded(std::floor(value / digit * (1.0 + 1e-12)) * digit, 4) + " " +
         std::string(units(dimension).front().name);
}

}  // namespace tremie::scene
