#pragma once

// Numbers as people and programs write them: with a decimal point or a decimal comma, with thousands separators or
// without. A column has one form; where its texts do not tell which, it is refused. Private to rheometer/records.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tremie::detail {

struct NumberCell {
  std::string text;
  long line = 0;           ///< of the file, from 1
  std::size_t column = 0;  ///< of the file, from 1
};

/// What a text is by either decimal mark; thousands separators, if any, are the other mark, blanks or apostrophes.
struct NumberReadings {
  std::optional<double> by_point, by_comma;

  bool none() const { return !by_point && !by_comma; }
  bool point_alone() const { return by_point && !by_comma; }
  bool comma_alone() const { return by_comma && !by_point; }
  bool ambiguous() const { return by_point && by_comma && *by_point != *by_comma; }
};

NumberReadings readings_of(std::string_view text);

/// Whether a text is meant as a number: digits and what goes with them, nothing else.
bool looks_like_a_number(std::string_view text);

/// The seconds of a clock's time, "00:01:30.5" or "01:30.5"; empty for any other text.
std::optional<double> clock_seconds(std::string_view text);

/// The numbers of each column. `others`: texts beside them, which may tell the file's decimal mark. `decimal`: "point",
/// "comma", or "auto" for what the texts tell. Throws RecordError, with the lines, for a text that is no number, for two
/// forms that contradict each other in one column, and for a column that can be read in two ways.
std::vector<std::vector<double>> numbers_of(const std::vector<std::vector<NumberCell>>& columns,
                                            const std::vector<NumberCell>& others, const std::string& decimal,
                                            const std::string& name);

}  // namespace tremie::detail
