#pragma once

// Samples, ages or ramps under one header: which rows of a table are one curve. Private to rheometer/tables.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "rheometer/tables/number_column.hpp"

namespace tremie::detail {

/// Rows that one of several tables under a header has at least.
inline constexpr std::size_t fewest_of_group = 3;

/// The texts of a table's rows, and what its columns are.
struct GroupedRows {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> named;   ///< columns whose names tell groups: samples, ramps
  std::vector<std::size_t> others;  ///< columns that are no quantities
  std::vector<double> abscissa;     ///< speeds or shear rates; empty where there are none
  std::vector<double> clock;        ///< times; empty where there are none
};

struct Groups {
  std::vector<std::size_t>
      starts;  ///< rows where another group begins; empty where there is one, or none is told apart
  std::vector<std::string> label;  ///< of each row, where there are groups
  std::size_t column = 0;          ///< of the table that tells them
  std::string mixed;  ///< "A to B": groups whose rows alternate, or whose clock goes on; empty for none
};

/// Rows where a text is another one than before.
inline std::vector<std::size_t> changes_of(const std::vector<std::string>& label) {
  std::vector<std::size_t> at;
  for (std::size_t i = 1; i < label.size(); ++i)
    if (label[i] != label[i - 1]) at.push_back(i);
  return at;
}

/// Whether every text comes once, and for as many rows as a group has at least.
inline bool stand_apart(const std::vector<std::string>& label, const std::vector<std::size_t>& starts) {
  std::map<std::string, int> seen{{label.front(), 1}};
  std::size_t before = 0;
  for (const std::size_t at : starts) {
    if (at - before < fewest_of_group || ++seen[label[at]] > 1) return false;
    before = at;
  }
  return label.size() - before >= fewest_of_group;
}

/// Whether each group goes through the speeds of the one before, by half of the smaller range at least: the steps of one curve
/// go on where the last one ended.
inline bool go_through_the_same(const std::vector<double>& x, const std::vector<std::size_t>& starts) {
  double low_before = 0.0, high_before = 0.0;
  for (std::size_t g = 0; g <= starts.size(); ++g) {
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(g == 0 ? 0 : starts[g - 1]),
               end = g == starts.size() ? x.end() : x.begin() + static_cast<std::ptrdiff_t>(starts[g]);
    const double low = *std::min_element(begin, end), high = *std::max_element(begin, end);
    const double common = std::min(high, high_before) - std::max(low, low_before),
                 smaller = std::min(high - low, high_before - low_before);
    if (!(high > low) || (g > 0 && common < 0.5 * smaller)) return false;
    low_before = low, high_before = high;
  }
  return true;
}

/// Whether rows of several groups alternate: every text has the same speeds, three or more.
inline bool alternate(const std::vector<std::string>& label, const std::vector<double>& x) {
  std::map<std::string, std::vector<double>> of;
  for (std::size_t i = 0; i < label.size(); ++i) of[label[i]].push_back(x[i]);
  if (of.size() < 2 || fewest_of_group * of.size() > label.size()) return false;
  for (auto& [text, speeds] : of) std::sort(speeds.begin(), speeds.end());
  const std::vector<double>& first = of.begin()->second;
  if (first.size() < fewest_of_group || !(first.back() > first.front())) return false;
  return std::all_of(of.begin(), of.end(), [&](const auto& one) {
    const std::vector<double>& speeds = one.second;
    return std::equal(speeds.begin(), speeds.end(), first.begin(), first.end(),
                      [](double a, double b) { return std::abs(a - b) <= 0.01 * std::abs(b); });
  });
}

/// Groups by the columns that are named so, or by any other column whose texts part rows that go through the same speeds. Where
/// the clock goes on, named ones alone are groups, and each begins with the clock.
inline Groups groups_of(const GroupedRows& table) {
  Groups groups;
  const std::size_t rows = table.rows.size();
  if (rows < 2 * fewest_of_group) return groups;
  const auto texts_of = [&](const std::vector<std::size_t>& columns) {
    std::vector<std::string> label(rows);
    for (std::size_t i = 0; i < rows; ++i)
      for (const std::size_t c : columns)
        if (c < table.rows[i].size()) label[i] += (label[i].empty() ? "" : ", ") + table.rows[i][c];
    return label;
  };
  const auto mixed = [&](const std::vector<std::string>& label, std::size_t column) {
    const std::size_t at = changes_of(label).front();
    groups.mixed = label[at - 1] + " to " + label[at], groups.column = column;
  };
  if (!table.named.empty()) {
    const auto label = texts_of(table.named);
    const auto starts = changes_of(label);
    const bool again = std::all_of(starts.begin(), starts.end(), [&](std::size_t i) {
      return table.clock.empty() || table.clock[i] < table.clock[i - 1];
    });
    if (!starts.empty() && again && stand_apart(label, starts))
      return {starts, label, table.named.front(), {}};
    const std::set<std::string> texts(label.begin(), label.end());
    if (!starts.empty() && texts.size() < rows) mixed(label, table.named.front());
  }
  if (!table.clock.empty() || table.abscissa.empty()) return groups;
  for (const std::size_t column : table.others) {
    const auto label = texts_of({column});
    const auto starts = changes_of(label);
    if (starts.empty()) continue;
    if (stand_apart(label, starts) && go_through_the_same(table.abscissa, starts))
      return {starts, label, column, {}};
    if (groups.mixed.empty() && alternate(label, table.abscissa)) mixed(label, column);
  }
  return groups;
}

}  // namespace tremie::detail
