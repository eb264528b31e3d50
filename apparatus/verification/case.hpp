#pragma once

// What a verification case measures: plain data, filled by the cases and written by
// apparatus/verification/document.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/run/machine/stopwatch.hpp"

namespace tremie::verification {

/// One solution at one resolution.
struct Run {
  std::string label;      ///< of the resolution, for a person: "5 x 2.5 mm"
  double h = 0.0;         ///< what is refined, in any unit; 0: nothing is
  double error = 0.0;     ///< in the norm of its case
  double cpu = 0.0;       ///< [s]
  std::string note = {};  ///< "3 unconverged steps"
};

/// One scheme over resolutions, coarse to fine.
struct Series {
  std::string scheme;
  std::vector<Run> runs = {};
};

/// What a case must keep. `value` and `limit` are in the words of `what`.
struct Bound {
  std::string what;
  double value = 0.0, limit = 0.0;
  bool at_least = false;  ///< value >= limit keeps it, else value <= limit
  bool kept() const { return at_least ? value >= limit : value <= limit; }
};

/// An equation, its reference and what was measured against it.
struct Problem {
  std::string name;  ///< also of its files: "film_exact"
  std::string title;
  std::string equation;
  std::string reference;  ///< the exact or reference solution, and its source
  std::string norm;       ///< of the error
  std::vector<Series> series = {};
  std::vector<Bound> bounds = {};
  std::vector<std::string> notes = {};
};

/// Rows of words, for what is no error over a resolution.
struct Table {
  std::string name;  ///< also of its file
  std::string text;  ///< above it
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows = {};
  std::vector<Bound> bounds = {};
};

struct Case {
  int number = 0;
  std::string title;
  std::vector<Problem> problems = {};
  std::vector<Table> tables = {};
};

enum class Depth { quick, full };

/// Least-squares slope of log error over log h; not-a-number below two errors that are not zero.
double observed_order(const Series& series);

/// Bounds the error of every scheme: of its run number `run`, or at its finest cells. "ADMM" + `where` names the bound.
void bound_errors(Problem& problem, const std::string& where, double limit,
                  std::optional<std::size_t> run = {});

/// "3 unconverged steps", the note of a run; empty for none.
std::string unconverged(std::int64_t steps);

}  // namespace tremie::verification
