#include "apparatus/report/compare/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apparatus/scene/input_error.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void check_folders(const std::vector<std::string>& folders) {
  if (folders.size() < 2)
    throw scene::InputError("compare: takes two or more folders of results: tremie compare runs/a runs/b");
  if (folders.size() > most_compared)
    throw scene::InputError(fmt::format(
        "compare: takes at most {} folders, not {}; tremie study runs and tells apart many scenes",
        most_compared, folders.size()));
  for (std::size_t i = 0; i < folders.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      std::error_code error;
      if (fs::equivalent(folders[i], folders[j], error) && !error)
        throw scene::InputError(fmt::format("{}: is the same folder as {}", folders[i], folders[j]));
    }
}

void check_apparatus(const std::vector<RunResult>& runs) {
  for (const auto& run : runs)
    if (run.apparatus != runs.front().apparatus)
      throw scene::InputError(fmt::format("{}: holds a {}, {} a {}; compare takes results of one apparatus",
                                          run.folder, run.apparatus, runs.front().folder,
                                          runs.front().apparatus));
}

/// Paths in place of names that two runs share.
void tell_apart(std::vector<RunResult>& runs) {
  std::vector<std::string> names;
  for (const auto& run : runs) names.push_back(run.name);
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (std::count(names.begin(), names.end(), names[i]) > 1) runs[i].name = runs[i].folder;
}

std::optional<double> error_of(const RunResult& run, const std::string& key) {
  const Entry* entry = find_entry(run.errors, key);
  return entry ? entry->number : std::nullopt;
}

void set_difference(const std::vector<RunResult>& runs, ComparedRow& row) {
  const auto& numbers = row.numbers;
  if (!std::all_of(numbers.begin(), numbers.end(), [](const auto& n) { return n.has_value(); })) return;
  const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
  row.difference = **high - **low;
  const auto a = error_of(runs[static_cast<std::size_t>(low - numbers.begin())], row.key);
  const auto b = error_of(runs[static_cast<std::size_t>(high - numbers.begin())], row.key);
  if (a && b) row.error = std::hypot(*a, *b);
}

ComparedRow row_of(const std::vector<RunResult>& runs, std::vector<Entry> RunResult::*part,
                   const std::string& key) {
  ComparedRow row{.key = key};
  for (const auto& run : runs) {
    const Entry* entry = find_entry(run.*part, key);
    row.texts.push_back(entry ? entry->text : "–");
    row.numbers.push_back(entry ? entry->number : std::nullopt);
    row.errors.push_back(row.numbers.back() && part == &RunResult::results ? error_of(run, key)
                                                                           : std::nullopt);
    row.differs = row.differs || row.texts.back() != row.texts.front();
  }
  set_difference(runs, row);
  return row;
}

/// The keys of every run, in the order of their first appearance.
std::vector<ComparedRow> rows_of(const std::vector<RunResult>& runs, std::vector<Entry> RunResult::*part) {
  std::vector<ComparedRow> rows;
  for (const auto& run : runs)
    for (const Entry& entry : run.*part)
      if (std::none_of(rows.begin(), rows.end(), [&](const auto& r) { return r.key == entry.key; }))
        rows.push_back(row_of(runs, part, entry.key));
  return rows;
}

std::string csv_field(const std::string& text) {
  if (text == "–") return {};
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted;
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return fmt::format("\"{}\"", quoted);
}

void add_csv(const char* part, const ComparedRow& row, std::string& csv) {
  csv += fmt::format("{},{}", part, csv_field(row.key));
  for (const auto& text : row.texts) csv.append(1, ',').append(csv_field(text));
  csv += '\n';
}

Json values_json(const ComparedRow& row) {
  Json values = Json::array();
  for (std::size_t i = 0; i < row.texts.size(); ++i)
    if (row.numbers[i])
      values.push_back(*row.numbers[i]);
    else
      values.push_back(row.texts[i] == "–" ? Json(nullptr) : Json(row.texts[i]));
  return values;
}

}  // namespace

Comparison compare(const std::vector<std::string>& folders) {
  check_folders(folders);
  Comparison comparison;
  for (const auto& folder : folders) comparison.runs.push_back(read_run_result(folder));
  check_apparatus(comparison.runs);
  tell_apart(comparison.runs);
  comparison.scene = rows_of(comparison.runs, &RunResult::scene);
  comparison.results = rows_of(comparison.runs, &RunResult::results);
  return comparison;
}

std::string comparison_csv(const Comparison& comparison) {
  std::string csv = "part,key";
  for (const auto& run : comparison.runs) csv.append(1, ',').append(csv_field(run.name));
  csv += '\n';
  for (const auto& row : comparison.scene)
    if (row.differs) add_csv("scene", row, csv);
  for (const auto& row : comparison.results) add_csv("result", row, csv);
  return csv;
}

Json comparison_json(const Comparison& comparison) {
  Json runs = Json::array(), scenes = Json::object(), results = Json::object();
  for (const auto& run : comparison.runs)
    runs.push_back({{"name", run.name},
                    {"folder", run.folder},
                    {"apparatus", run.apparatus},
                    {"status", run.status},
                    {"trusted", run.reasons.empty() && run.status == "completed"}});
  for (const auto& row : comparison.scene)
    if (row.differs) scenes[row.key] = values_json(row);
  for (const auto& row : comparison.results)
    if (row.differs)
      results[row.key] = {{"values", values_json(row)},
                          {"difference", row.difference ? Json(*row.difference) : Json(nullptr)},
                          {"difference_error", row.error ? Json(*row.error) : Json(nullptr)}};
  return {{"runs", runs}, {"scene_differences", scenes}, {"result_differences", results}};
}

std::vector<std::string> comparison_reasons(const Comparison& comparison) {
  std::vector<std::string> reasons;
  for (const auto& run : comparison.runs) {
    for (const auto& reason : run.reasons) reasons.push_back(fmt::format("{}: {}", run.name, reason));
    if (run.reasons.empty() && run.status != "completed")
      reasons.push_back(fmt::format("{}: the run is {}", run.name, run.status));
  }
  return reasons;
}

std::string error_sentence(const Comparison& comparison) {
  std::vector<std::string> with, without;
  for (const auto& run : comparison.runs) (run.errors.empty() ? without : with).push_back(run.name);
  if (with.empty())
    return "The runs state no error by cells and steps (--with-error), so a small difference may be theirs.";
  if (without.empty())
    return "The ± of a difference is by cells and steps, of the two runs that are furthest apart.";
  return fmt::format(
      "{} {} the error by cells and steps, the ± beside a number; {} {} not (--with-error), so a difference "
      "from {} has no ±.",
      fmt::join(with, ", "), with.size() == 1 ? "states" : "state", fmt::join(without, ", "),
      without.size() == 1 ? "does" : "do", without.size() == 1 ? "it" : "them");
}

std::string scene_sentence(const Comparison& comparison) {
  if (comparison.scene.empty()) return {};
  constexpr std::size_t most = 6, longest = 80;
  std::vector<std::string> parts;
  std::size_t n = 0;
  for (const auto& row : comparison.scene)
    if (row.differs) {
      const std::string values = fmt::format("{}", fmt::join(row.texts, " | "));
      if (parts.size() < most && values.size() <= longest)
        parts.push_back(fmt::format("{}: {}", row.key, values));
      ++n;
    }
  if (n == 0) return "The scenes are the same.";
  if (parts.empty()) return fmt::format("The scenes differ in {} keys.", n);
  const std::size_t more = n - parts.size();
  return fmt::format("The scenes differ in {}{}.", fmt::join(parts, "; "),
                     more > 0 ? fmt::format("; and {} more", more) : "");
}

}  // namespace tremie::report
