#pragma once

// Lines and fields of a text table, quoted as RFC 4180 has it. Private to rheometer/records.

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

}  // namespace tremie::detail
