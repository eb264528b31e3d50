#include "apparatus/study/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/scene/input_error.hpp"

namespace tremie::study {
namespace {

constexpr std::size_t most_rows = 1000000;

std::vector<Level> grid_levels(const Factor& factor, std::size_t count) {
  if (!factor.values.empty()) return factor.values;
  std::vector<Level> levels;
  for (std::size_t i = 0; i < count; ++i)
    levels.push_back(level_at(factor, static_cast<double>(i) / static_cast<double>(count - 1)));
  return levels;
}

/// The last factor changes fastest.
Design grid(const Definition& study) {
  Design design{{}};
  for (const Factor& factor : study.factors) {
    const auto levels = grid_levels(factor, study.levels);
    if (design.size() * levels.size() > most_rows)
      throw scene::InputError(fmt::format("{}: design.levels: makes more than {} rows; take fewer levels",
                                          study.file.string(), most_rows));
    Design longer;
    for (const auto& row : design)
      for (const Level& level : levels) {
        longer.push_back(row);
        longer.back().push_back(level);
      }
    design = std::move(longer);
  }
  return design;
}

}  // namespace

Design make_design(const Definition& study) {
  if (study.method == Method::grid) return grid(study);
  Design design;
  for (const auto& point : unit_points(study.method, study.runs, study.factors.size(), study.seed)) {
    std::vector<Level> row;
    for (std::size_t i = 0; i < point.size(); ++i) row.push_back(level_at(study.factors[i], point[i]));
    design.push_back(std::move(row));
  }
  return design;
}

std::vector<std::string> overrides_of(const Definition& study, const std::vector<Level>& row) {
  std::vector<std::string> overrides;
  for (std::size_t i = 0; i < row.size(); ++i) overrides.push_back(study.factors[i].key + "=" + row[i].text);
  return overrides;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_fields(const std::vector<Level>& row) {
  std::string text;
  for (const Level& level : row)
    text += fmt::format(
        ",{}", std::isfinite(level.number) ? scene::write_number(level.number) : csv_field(level.text));
  return text;
}

std::string design_csv(const Definition& study, const Design& design) {
  std::string csv = "row";
  for (const Factor& factor : study.factors) csv += fmt::format(",{}", csv_field(column_of(factor)));
  csv += "\n";
  for (std::size_t i = 0; i < design.size(); ++i) {
    csv += fmt::format("{}", i);
    csv += csv_fields(design[i]);
    csv += "\n";
  }
  return csv;
}

}  // namespace tremie::study
