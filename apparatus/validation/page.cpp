#include <fmt/format.h>

#include <cmath>

#include "apparatus/validation/validation.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::validation {
namespace {

/// Digits behind the point that a person wants to read.
int digits_of(double value) {
  const double size = std::abs(value);
  return size >= 100.0 ? 0 : size >= 10.0 ? 1 : 2;
}

std::string with_error(double value, double error) {
  const int digits = digits_of(value);
  if (!std::isfinite(value)) return "—";
  return std::isfinite(error) ? fmt::format("{:.{}f} ± {:.{}f}", value, digits, error, digits)
                              : fmt::format("{:.{}f}", value, digits);
}

bool is_missed(const Comparison& c) { return verdict(c) == "missed"; }

std::string row(const Comparison& c) {
  const double off = c.predicted - c.measured;
  const std::string judged =
      is_missed(c) ? fmt::format("**missed**, {:+.{}f}", off, digits_of(c.measured)) : verdict(c);
  return fmt::format("|{}|{}|{}|{}|\n", c.unit.empty() ? c.what : c.what + ", " + c.unit,
                     with_error(c.measured, c.measured_error), with_error(c.predicted, c.predicted_error),
                     judged);
}

std::string section_text(const Section& section) {
  std::string text = fmt::format("## {}\n\n{}\n\n| |measured|predicted|verdict|\n|---|---|---|---|\n",
                                 section.title, section.text);
  for (const Comparison& c : section.comparisons) text += row(c);
  for (const auto& finding : section.findings) text += "\n" + finding + "\n";
  return text + "\n";
}

std::string head(const std::vector<Section>& sections, double wall_seconds) {
  std::size_t met = 0, missed = 0, open = 0;
  for (const Section& s : sections)
    for (const Comparison& c : s.comparisons) {
      const bool miss = is_missed(c);
      (miss ? missed : verdict(c) == "met" ? met : open) += 1;
    }
  return fmt::format(
      "# Validation\n\nMeasurements beside Tremie's predictions; the last table has two published "
      "correlations. `tremie verify --validation` remakes this page ({:.0f} s), its charts and "
      "`validation.csv`.\n\n**{} of {} met, {} missed, {} without a verdict.** ± is half of a 95 % interval. "
      "Met: the difference is within the combined interval (root of the sum of squares). A row whose "
      "computed "
      "± exceeds the measured one has no verdict. Rows by the default kinetics or "
      "by a = 0.1 use an exponent that was chosen with them in view.\n\n",
      wall_seconds, met, met + missed + open, missed, open);
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{:.5g}", value) : ""; }

std::string csv(const std::vector<Section>& sections) {
  std::string text = "section,what,unit,measured,measured_error,predicted,predicted_error,verdict\n";
  for (const Section& s : sections)
    for (const Comparison& c : s.comparisons)
      text += fmt::format("{},\"{}\",{},{},{},{},{},\"{}\"\n", s.name, c.what, c.unit, csv_number(c.measured),
                          csv_number(c.measured_error), csv_number(c.predicted),
                          csv_number(c.predicted_error), verdict(c));
  return text;
}

}  // namespace

std::string verdict(const Comparison& c) {
  if (!c.note.empty()) return c.note;
  const double both =
      std::hypot(c.measured_error, std::isfinite(c.predicted_error) ? c.predicted_error : 0.0);
  if (std::abs(c.predicted - c.measured) > both) return "missed";
  return c.predicted_error > c.measured_error ? "none: computed ± too wide" : "met";
}

std::vector<Section> all_sections(const Settings& settings) {
  std::vector<Section> sections;
  for (const auto make :
       {paper_mixes, breakdown_of_pairs, sliding_floor, torque_records, slump_pairs, stiff_mixes}) {
    sections.push_back(make(settings));
    if (settings.say) settings.say(sections.back().title);
  }
  return sections;
}

void write_page(const std::vector<Section>& sections, double wall_seconds,
                const std::filesystem::path& folder) {
  std::string text = head(sections, wall_seconds);
  for (const Section& section : sections) text += section_text(section);
  io::write_text(folder / "VALIDATION.md", text);
  io::write_text(folder / "validation.csv", csv(sections));
}

}  // namespace tremie::validation
