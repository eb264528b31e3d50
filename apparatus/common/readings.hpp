#pragma once

// A reading is a row: an apparatus lists what it reads in one table, and summary.json, timeseries.csv, results.h5, the screen,
// the report, the reference, comparisons, studies, calibrations and Python take names, words, units and values from there.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/outcome.hpp"

namespace tremie::scene {

/// A run as the rows of its table and its checks see it; an apparatus may add to it what else they need.
template <class SceneOfRun, class RecordOfRun>
struct RunView {
  using Sample = typename RecordOfRun::Sample;
  const SceneOfRun& scene;
  const RecordOfRun& run;
  Status status = run.status;
  const typename RecordOfRun::Results& r = run.results;
  const std::vector<Sample>& series = run.series;
};

/// One reading: a result where it has a `value`, a column over time where it has an `at`. View: what it is computed from, the
/// scene and the raw run; View::Sample is a line of the run's series, View::series all of them. The unit is the one that the
/// name ends with. An empty function stands for always, or for nothing.
template <class View>
struct Reading {
  using Sample = typename View::Sample;
  std::string name;                        ///< "spread_mm"; "input.alpha" is alpha in the object "input"
  std::string words = {};                  ///< "slump flow, mean diameter"; empty: made from the name
  ResultValue (*value)(const View&) = {};  ///< the result
  double (*at)(const View&, const Sample&) = {};  ///< the column; not-a-number for no value
  std::string label = {};                         ///< begins its line on the screen; empty: none there
  int digits = 0;                                 ///< behind the point, on the screen and in an answer
  std::string (*none)(const View&) = {};          ///< said in place of null
  std::string (*remark)(const View&) = {};        ///< behind the value on the screen
  std::optional<std::string> (*answer)(
      const View&) = {};              ///< word before it in a report's first line; empty: not there
  int headline = 0;                   ///< rank among the numbers that error bars are for; 0: none
  int headline_digits = 0;            ///< behind the point with an error bar
  bool measurable = false;            ///< whether a laboratory measures it: for `tremie calibrate`
  bool (*applies)(const View&) = {};  ///< whether the run has it
  std::vector<std::string> (*lines)(const View&) = {};  ///< on the screen in place of the usual line
};

/// A table that goes over something else than time, and its columns.
template <class Row>
struct TableOf {
  struct Column {
    std::string name, words;
    double (*value)(const Row&);
  };
  std::string file;  ///< "profile.csv"
  std::vector<Column> columns;
};

/// A result or a column by its name, and what it means.
struct Described {
  std::string name, words;
  bool is_result = false, measurable = false;
  std::string file = {};  ///< where it is a column; empty: nowhere
};

/// A number that a person looks at first; `digits` behind the point with an error bar.
struct Headline {
  std::string name, word;
  int digits = 0;
};

/// "mm", "1/s", "N.m": the unit that a name ends with; "1" for none. Endings are those of readings.cpp: a speed ends with
/// "_mm_per_s", since "_mm_s" would be seconds.
std::string unit_of(const std::string& name);

/// The name without the ending that tells its unit: "spread" of "spread_mm".
std::string name_without_unit(const std::string& name);

/// The same as people write it: "N·m"; empty for none. Volumes are in litres.
std::string unit_for_people(const std::string& name);

/// A name without its unit, in words: "torque_wall_N_m" is "torque wall".
std::string words_from_name(const std::string& name);

/// A value under its dotted name in nested results.
void put_result(const std::string& dotted, ResultValue value, std::vector<Result>& results);

/// null for the group of a dotted name that has no value yet.
void put_empty_group(const std::string& dotted, std::vector<Result>& results);

/// "spread          544 mm   class SF1", or the words for none.
std::string reading_line(const std::string& label, const std::string& name, const ResultValue& value,
                         int digits, const std::string& none, const std::string& remark);

/// Fills results, series, lines, answers and words for none from the table.
template <class View>
void read_into(const std::vector<Reading<View>>& table, const View& view, Outcome& outcome) {
  std::vector<const Reading<View>*> answers;
  for (const Reading<View>& row : table) {
    const bool applies = !row.applies || row.applies(view);
    if (row.at && applies) {
      outcome.series.push_back({row.name, {}});
      for (const auto& sample : view.series) outcome.series.back().values.push_back(row.at(view, sample));
    }
    if (row.value && !applies) put_empty_group(row.name, outcome.results);
    if (!row.value || !applies) continue;
    const ResultValue value = row.value(view);
    put_result(row.name, value, outcome.results);
    const std::string none = row.none ? row.none(view) : std::string{};
    if (!none.empty()) outcome.none.emplace_back(row.name, none);
    if (row.lines)
      for (std::string& line : row.lines(view)) outcome.lines.push_back(std::move(line));
    else if (!row.label.empty())
      outcome.lines.push_back(reading_line(row.label, row.name, value, row.digits, none,
                                           row.remark ? row.remark(view) : std::string{}));
    if (row.answer && row.answer(view)) answers.push_back(&row);
  }
  std::stable_sort(answers.begin(), answers.end(),
                   [](const auto* a, const auto* b) { return a->headline < b->headline; });
  for (const auto* row : answers) outcome.answers.push_back({row->name, *row->answer(view), row->digits});
}

template <class Row>
ResultTable table_from(const TableOf<Row>& table, const std::vector<Row>& rows) {
  ResultTable filled{table.file, {}};
  for (const auto& c : table.columns) {
    filled.columns.push_back({c.name, {}});
    for (const Row& row : rows) filled.columns.back().values.push_back(c.value(row));
  }
  return filled;
}

/// The headline numbers of a table, by rank.
template <class View>
std::vector<Headline> headlines_of(const std::vector<Reading<View>>& table) {
  std::vector<const Reading<View>*> rows;
  for (const auto& row : table)
    if (row.headline > 0) rows.push_back(&row);
  std::sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->headline < b->headline; });
  std::vector<Headline> headlines;
  for (const auto* row : rows) headlines.push_back({row->name, row->label, row->headline_digits});
  return headlines;
}

template <class View>
void describe(const std::vector<Reading<View>>& table, std::vector<Described>& all) {
  for (const auto& row : table)
    all.push_back(
        {row.name, row.words, row.value != nullptr, row.measurable, row.at ? "timeseries.csv" : ""});
}
template <class Row>
void describe(const TableOf<Row>& table, std::vector<Described>& all) {
  for (const auto& row : table.columns) all.push_back({row.name, row.words, false, false, table.file});
}

/// Names and words of an apparatus' tables, for the glossary and the reference.
template <class... Tables>
std::vector<Described> described(const Tables&... tables) {
  std::vector<Described> all;
  (describe(tables, all), ...);
  return all;
}

/// A reason why a result is not to be trusted, or nothing: a row of an apparatus' checks.
template <class View>
using Check = std::string (*)(const View&);

template <class View>
void add_reasons(const std::vector<Check<View>>& checks, const View& view,
                 std::vector<std::string>& reasons) {
  for (const Check<View> check : checks)
    if (std::string reason = check(view); !reason.empty()) reasons.push_back(std::move(reason));
}

}  // namespace tremie::scene
