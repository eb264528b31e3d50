#include "apparatus/study/rows/summary.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apparatus/study/rows/indices.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double most_doubtful = 0.1;  ///< share of the rows

std::size_t count(const Collected& collected, int exit_code) {
  return static_cast<std::size_t>(std::count_if(collected.rows.begin(), collected.rows.end(),
                                                [&](const Row& row) { return row.exit_code == exit_code; }));
}

std::string list_of(const std::vector<std::size_t>& rows) {
  constexpr std::size_t most = 10;
  const auto end = rows.begin() + static_cast<std::ptrdiff_t>(std::min(most, rows.size()));
  const std::vector<std::size_t> first(rows.begin(), end);
  return fmt::format("{}{}", fmt::join(first, ", "), rows.size() > most ? " and more" : "");
}

std::vector<std::string> reasons_of(const Design& design, const Collected& collected) {
  std::vector<std::string> reasons = collected.problems;
  if (!collected.missing.empty())
    reasons.push_back(fmt::format("{} of {} rows are missing: {}", collected.missing.size(), design.size(),
                                  list_of(collected.missing)));
  const std::size_t doubtful = collected.rows.size() - count(collected, 0);
  if (static_cast<double>(doubtful) > most_doubtful * static_cast<double>(design.size()))
    reasons.push_back(fmt::format("{} of {} rows failed or are not to be trusted (study.csv says why)",
                                  doubtful, design.size()));
  return reasons;
}

Json results_json(const Design& design, const Collected& collected) {
  Json json;
  json["rows"] = design.size();
  json["rows_done"] = count(collected, 0);
  json["rows_not_to_be_trusted"] = count(collected, 3);
  json["rows_failed"] = collected.rows.size() - count(collected, 0) - count(collected, 3);
  json["rows_missing"] = collected.missing.size();
  json["rows_moving_at_end"] = moving_rows(collected);
  double cpu = 0.0;
  for (const Row& row : collected.rows) cpu += row.cpu;
  json["rows_cpu_s"] = cpu;
  return json;
}

Json json_of(const Definition& study, const ResultIndices& one) {
  Json json{{"rows", one.rows}, {"variance_explained", one.explained}};
  for (std::size_t i = 0; i < study.factors.size(); ++i) {
    const SobolIndex& index = one.indices[i];
    const MainEffect& effect = one.main_effects[i];
    Json at = Json::array();
    for (const double x : effect.at) at.push_back(std::isfinite(x) ? Json(x) : Json(nullptr));
    json["factors"][study.factors[i].key] = {
        {"first", index.first},
        {"first_error", index.first_error},
        {"total", index.total},
        {"total_error", index.total_error},
        {"main_effect", {{"unit", unit_of(study.factors[i])}, {"at", at}, {"mean", effect.mean}}}};
  }
  return json;
}

Json sobol_json(const Definition& study, const std::vector<ResultIndices>& indices, const std::string& note) {
  Json json = Json::object();
  for (const auto& one : indices) json[one.result] = json_of(study, one);
  if (!note.empty()) json["note"] = note;
  return json;
}

}  // namespace

void write_whole(const fs::path& file, const std::string& text) {
  const fs::path part = file.parent_path() / fmt::format(".{}.{}.part", file.filename().string(), getpid());
  io::write_text(part, text);
  fs::rename(part, file);
}

std::vector<std::string> write_results(const Definition& study, const Design& design,
                                       const Collected& collected, const std::vector<ResultIndices>& indices,
                                       const std::string& note, const fs::path& folder,
                                       const Stopwatch& watch) {
  write_whole(folder / "study.csv", study_csv(study, design, collected));
  const fs::path h5 = folder / fmt::format(".study.{}.part", getpid());
  write_study_h5(h5, study, design, collected);
  fs::rename(h5, folder / "study.h5");
  scene::Outcome outcome;
  outcome.apparatus = "study";
  outcome.checks.reasons = reasons_of(design, collected);
  Json results = results_json(design, collected);
  results["sobol"] = sobol_json(study, indices, note);
  watch.stop(outcome.cost);
  Json summary = cli::summary_of(outcome);
  summary["results"] = results;
  write_whole(folder / "summary.json", summary.dump(2) + "\n");
  return outcome.checks.reasons;
}

}  // namespace tremie::study
