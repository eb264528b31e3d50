#include "apparatus/report/run_files/glossary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "apparatus/registry/registry.hpp"

namespace tremie::report {
namespace {

using Words = std::map<std::string, std::string>;

/// What no apparatus has for itself: the names of all, and the fields of frames.
Words common_words() {
  Words words{{"position", "places of the points"},          {"velocity", "velocities of the points"},
              {"volume", "volumes of the points"},           {"pressure", "pressures of the points"},
              {"shear_rate", "shear rates of the points"},   {"flocculation", "flocculation state λ"},
              {"age", "age of the concrete since batching"}, {"load", "number of its load"}};
  for (const auto& apparatus : scene::all_apparatus()) words[apparatus.keys.name] = apparatus.words;
  return words;
}

/// The words of each apparatus; under no name those of all, where the first apparatus that has a name gives its words.
std::map<std::string, Words> all_words() {
  std::map<std::string, Words> all{{"", common_words()}};
  for (const auto& apparatus : scene::all_apparatus())
    for (const auto& reading : apparatus.glossary)
      if (!reading.words.empty()) {
        all[apparatus.keys.name].emplace(reading.name, reading.words);
        all[""].emplace(reading.name, reading.words);
      }
  return all;
}

}  // namespace

std::string words_of(const std::string& name, const std::string& apparatus) {
  static const std::map<std::string, Words> all = all_words();
  for (const std::string& of : {apparatus, std::string()})
    if (const auto words = all.find(of); words != all.end())
      if (const auto found = words->second.find(name); found != words->second.end()) return found->second;
  return scene::words_from_name(name);
}

std::string with_unit(const std::string& words, const std::string& unit) {
  return unit.empty() ? words : fmt::format("{} ({})", words, unit);
}

std::string person_number(double value, const std::string& name) {
  if (!std::isfinite(value)) return "–";
  if (unit_of(name) == "m3") value *= 1e3;  // litres, as unit_for_people() says
  if (unit_of(name) == "mm") return fmt::format("{:.{}f}", value, std::abs(value) < 10.0 ? 1 : 0);
  // Runs are good to about a per cent: three digits.
  return std::abs(value) < 100.0 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

}  // namespace tremie::report
