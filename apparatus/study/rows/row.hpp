#pragma once

// One run of a study, and its line in the journal.

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apparatus/registry/registry.hpp"
#include "apparatus/study/definition.hpp"

namespace tremie::study {

/// A result that is read: none, a number in the unit of its name, or a word.
using Reading = std::variant<std::monostate, double, std::string>;

/// A run that is not to be trusted or that failed is a row too.
struct Row {
  std::size_t row = 0;
  std::vector<Reading> readings;  ///< in the order of Definition::results
  std::string status;             ///< "completed", "interrupted" or "failed"
  int exit_code = 0;              ///< as `tremie run` would end: 0, 1, 2 or 3
  std::vector<std::string> reasons;
  double cpu = 0.0;     ///< of the run [s]
  bool moving = false;  ///< its concrete still moved when its time was over: the results are of then
};

/// A reading's number where the run is to be trusted and has one.
std::optional<double> trusted_number(const Row& row, std::size_t reading);

/// The same in all but the time that it took.
bool same_result(const Row& a, const Row& b);

/// A reading by its dotted name; empty where the outcome has no such result.
std::optional<Reading> reading_of(const scene::Outcome& outcome, const std::string& name);

/// The names of an outcome's results, dotted.
std::vector<std::string> result_names(const std::vector<scene::Result>& results,
                                      const std::string& prefix = "");

/// Reads the scene with the overrides and runs it on one thread. Whatever goes wrong with the run stands in
/// the row. Throws scene::InputError where the outcome has no result of a name in `read.results`.
Row run_row(const Definition& study, std::size_t row, const std::vector<std::string>& overrides);

/// The same of a scene that `read` returns, for the results of these names; `place` stands before messages.
Row run_scene(const std::function<scene::Scene()>& read, const std::vector<std::string>& results,
              std::size_t row, const std::string& place);

/// The row of a process that died.
Row dead_row(std::size_t results, std::size_t row, const std::string& death);

/// One line of JSON, and back. Empty where the text is no whole line of a row.
std::string row_json(const Row& row);
std::optional<Row> row_from_json(const std::string& text, std::size_t results);

}  // namespace tremie::study
