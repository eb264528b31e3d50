#include "apparatus/study/rows/files.hpp"

#include <fmt/format.h>

#include <limits>

#include "libmpm/io/hdf5_file.hpp"

namespace tremie::study {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::string field_of(const Reading& reading) {
  if (const auto* number = std::get_if<double>(&reading)) return scene::write_number(*number);
  if (const auto* word = std::get_if<std::string>(&reading)) return csv_field(*word);
  return "";
}

std::string ran(const Row& row) {
  std::string text;
  for (const Reading& reading : row.readings) text += fmt::format(",{}", field_of(reading));
  return text + fmt::format(",{},{},{},{:.3f}", row.status, row.exit_code,
                            csv_field(fmt::format("{}", fmt::join(row.reasons, "; "))), row.cpu);
}

/// The row of the design's row i, which may have none.
std::vector<const Row*> by_number(std::size_t count, const Collected& collected) {
  std::vector<const Row*> rows(count, nullptr);
  for (const Row& row : collected.rows) rows[row.row] = &row;
  return rows;
}

}  // namespace

std::string study_csv(const Definition& study, const Design& design, const Collected& collected) {
  std::string csv = "row";
  for (const Factor& factor : study.factors) csv += fmt::format(",{}", csv_field(column_of(factor)));
  for (const std::string& result : study.results) csv += fmt::format(",{}", csv_field(result));
  csv += ",status,exit_code,reasons,cpu_s\n";
  const auto rows = by_number(design.size(), collected);
  for (std::size_t i = 0; i < design.size(); ++i) {
    csv += fmt::format("{}", i) + csv_fields(design[i]);
    csv += rows[i] ? ran(*rows[i]) : std::string(study.results.size(), ',') + ",missing,,nobody ran it,";
    csv += "\n";
  }
  return csv;
}

void write_study_h5(const std::filesystem::path& file, const Definition& study, const Design& design,
                    const Collected& collected) {
  const auto rows = by_number(design.size(), collected);
  io::Hdf5File h5(file);
  h5.attribute("/", "schema", std::int64_t{1});
  h5.attribute("/", "base_scene", study.resolved_base);
  h5.group("/factors");
  h5.group("/results");
  std::vector<double> column(design.size());
  for (std::size_t j = 0; j < study.factors.size(); ++j) {
    for (std::size_t i = 0; i < design.size(); ++i) column[i] = design[i][j].number;
    h5.array("/factors/" + column_of(study.factors[j]), column, 1, unit_of(study.factors[j]));
  }
  for (std::size_t j = 0; j < study.results.size(); ++j) {
    for (std::size_t i = 0; i < design.size(); ++i) {
      const auto* number = rows[i] ? std::get_if<double>(&rows[i]->readings[j]) : nullptr;
      column[i] = number ? *number : none;
    }
    h5.array("/results/" + study.results[j], column, 1, "");
  }
  for (std::size_t i = 0; i < design.size(); ++i) column[i] = rows[i] ? rows[i]->exit_code : none;
  h5.array("/exit_code", column, 1, "");
  for (std::size_t i = 0; i < design.size(); ++i) column[i] = rows[i] ? rows[i]->cpu : none;
  h5.array("/cpu_s", column, 1, "s");
  h5.close();
}

}  // namespace tremie::study
