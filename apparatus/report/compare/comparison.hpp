#pragma once

// Results side by side: what differs, and files that say so.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/report/compare/run_result.hpp"

namespace tremie::report {

inline constexpr std::size_t most_compared = 8;  ///< more curves than that nobody tells apart

/// One key over all runs. "–" stands where a run has no such value.
struct ComparedRow {
  std::string key;
  std::vector<std::string> texts = {};
  std::vector<std::optional<double>> numbers = {};
  bool differs = false;
  std::optional<double> difference = {};  ///< largest less smallest, where all are numbers
  std::optional<double> error = {};       ///< of that by cells and steps, where the two runs state one
  std::vector<std::optional<double>> errors = {};  ///< of each run's number, where it states one
};

struct Comparison {
  std::vector<RunResult> runs;
  std::vector<ComparedRow> scene, results;
};

/// Two to most_compared folders of one apparatus. Throws scene::InputError.
Comparison compare(const std::vector<std::string>& folders);

/// `part,key,RUN…`: a column a run; scene keys that differ, then all results.
std::string comparison_csv(const Comparison& comparison);

/// summary.json's "results": the runs, `scene_differences` and `result_differences` by key, a value a run.
nlohmann::ordered_json comparison_json(const Comparison& comparison);

/// Why a run among them is not to be trusted.
std::vector<std::string> comparison_reasons(const Comparison& comparison);

/// Which runs state an error by cells and steps, and what the ± are; in a sentence.
std::string error_sentence(const Comparison& comparison);

/// In a sentence: "The scenes differ in test.rest: 0 s | 240 s."
std::string scene_sentence(const Comparison& comparison);

/// The report: overlaid curves, tables. `command` repeats it.
std::string comparison_html(const Comparison& comparison, const std::string& command);

/// "slump flow of a and b: spread 544 | 348 mm".
std::string comparison_headline(const Comparison& comparison);

}  // namespace tremie::report
