#include "apparatus/report/run_files/glossary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "apparatus/registry/registry.hpp"

namespace tremie::report {
namespace {

/// What no apparatus has for itself: its name, and the fields of frames.
std::map<std::string, std::string> all_words() {
  std::map<std::string, std::string> words{
      {"position", "places of the points"},        {"velocity", "velocities of the points"},
      {"volume", "volumes of the points"},         {"pressure", "pressures of the points"},
      {"shear_rate", "shear rates of the points"}, {"flocculation", "flocculation state λ"}};
  for (const auto& apparatus : scene::all_apparatus()) {
    words[apparatus.keys.name] = apparatus.words;
    for (const auto& reading : apparatus.glossary)
      if (!reading.words.empty()) words[reading.name] = reading.words;
  }
  return words;
}

}  // namespace

std::string words_of(const std::string& name) {
  static const std::map<std::string, std::string> words = all_words();
  const auto found = words.find(name);
  return found == words.end() ? scene::words_from_name(name) : found->second;
}

std::string person_number(double value, const std::string& name) {
  if (!std::isfinite(value)) return "–";
  if (unit_of(name) == "m3") value *= 1e3;  // litres, as unit_for_people() says
  if (unit_of(name) == "mm") return fmt::format("{:.{}f}", value, std::abs(value) < 10.0 ? 1 : 0);
  // Runs are good to about a per cent: three digits.
  return std::abs(value) < 100.0 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

}  // namespace tremie::report
