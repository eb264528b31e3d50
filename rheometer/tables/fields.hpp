#pragma once

// Lines and fields of a text table, quoted as RFC 4180 has it. Private to rheometer/records.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tremie::detail {

/// A line of the file; one with an opened quote goes on to the line that closes it.
struct TextLine {
  long number = 0;  ///< from 1
  std::string_view text;
};

std::vector<TextLine> lines_of(std::string_view text);

/// Between the columns: a tab, ';', ',' or '|', runs of blanks (' '), or runs of two or more blanks.
inline constexpr char wide_blanks = '\x01';

/// The fields of a line, without quotes and without the blanks around them.
std::vector<std::string> fields_of(std::string_view line, char separator);

/// Without blanks, tabs and no-break spaces around it.
std::string_view trimmed(std::string_view text);

/// Lower case, letters of Latin-1 among them.
std::string lower(std::string_view text);

/// The fields of a row. A header that begins with a label, "Interval data:", names no column by it: rows that begin with a
/// number and have a field less are those without the label's place.
std::vector<std::string> row_fields(std::string_view line, char separator,
                                    const std::vector<std::string>& header);

bool all_empty(const std::vector<std::string>& fields);

std::size_t count_numbers(const std::vector<std::string>& fields);

/// What programs write where there is no value.
bool is_placeholder(const std::string& field);

/// "Mean", "SD": what heads a row of statistics below the readings.
bool is_a_statistic(const std::string& field);

/// Whether one of the columns of moduli has a number that is not 0, as the rows of an oscillation do.
bool measures_a_modulus(const std::vector<std::string>& fields, const std::vector<std::size_t>& moduli);

}  // namespace tremie::detail
