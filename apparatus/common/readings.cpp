#include "apparatus/common/readings.hpp"

#include <fmt/format.h>

#include <array>

namespace tremie::scene {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 14> endings{{{"_mm_per_s", "mm/s"},
                                                                       {"_m3_per_s", "m3/s"},
                                                                       {"_mm", "mm"},
                                                                       {"_m_per_s", "m/s"},
                                                                       {"_rev_per_s", "rev/s"},
                                                                       {"_Pa_per_s", "Pa/s"},
                                                                       {"_per_s", "1/s"},
                                                                       {"_Pa_s", "Pa.s"},
                                                                       {"_s", "s"},
                                                                       {"_J", "J"},
                                                                       {"_Pa", "Pa"},
                                                                       {"_N_m", "N.m"},
                                                                       {"_m3", "m3"},
                                                                       {"_m", "m"}}};

/// The results under a group's name; an empty group is made where there is none.
std::vector<Result>& group_of(const std::string& name, std::vector<Result>& results) {
  for (Result& result : results)
    if (result.name == name) {
      if (!std::holds_alternative<std::vector<Result>>(result.value)) result.value = std::vector<Result>{};
      return std::get<std::vector<Result>>(result.value);
    }
  results.push_back({name, std::vector<Result>{}});
  return std::get<std::vector<Result>>(results.back().value);
}

}  // namespace

std::string unit_of(const std::string& name) {
  for (const auto& [ending, unit] : endings)
    if (name.ends_with(ending)) return unit;
  return "1";
}

std::string name_without_unit(const std::string& name) {
  for (const auto& entry : endings)
    if (const std::string_view ending = entry.first; name.ends_with(ending))
      return name.substr(0, name.size() - ending.size());
  return name;
}

std::string unit_for_people(const std::string& name) {
  const std::string unit = unit_of(name);
  return unit == "1" ? "" : unit == "N.m" ? "N·m" : unit == "Pa.s" ? "Pa·s" : unit == "m3" ? "l" : unit;
}

std::string words_from_name(const std::string& name) {
  std::string text = name_without_unit(name);
  std::replace(text.begin(), text.end(), '_', ' ');
  std::replace(text.begin(), text.end(), '.', ' ');
  return text;
}

void put_result(const std::string& dotted, ResultValue value, std::vector<Result>& results) {
  const std::size_t dot = dotted.find('.');
  if (dot == std::string::npos)
    results.push_back({dotted, std::move(value)});
  else
    put_result(dotted.substr(dot + 1), std::move(value), group_of(dotted.substr(0, dot), results));
}

void put_empty_group(const std::string& dotted, std::vector<Result>& results) {
  const std::string group = dotted.substr(0, dotted.find('.'));
  if (group == dotted) return;
  for (const Result& result : results)
    if (result.name == group) return;
  results.push_back({group, std::monostate{}});
}

std::string reading_line(const std::string& label, const std::string& name, const ResultValue& value,
                         int digits, const std::string& none, const std::string& remark) {
  std::string text = none;
  if (const auto* number = std::get_if<double>(&value)) {
    const std::string unit = unit_of(name);
    text = fmt::format("{:.{}f}{}", *number, digits, unit == "1" ? "" : " " + unit);
  } else if (const auto* word = std::get_if<std::string>(&value)) {
    text = *word;
  }
  return fmt::format("{:<15} {}{}", label, text, remark);
}

}  // namespace tremie::scene
