#pragma once

// Text as instruments write it: UTF-16, Latin-1 or UTF-8; several header lines; German or English column names; units
// in the header or in a line of brackets below it; decimal commas; empty cells; headers that are repeated.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tremie {

/// The text as UTF-8 without a byte-order mark. Throws RecordError for what is no text: a workbook, a picture.
std::string decoded_text(std::string_view bytes, const std::string& name);

/// An export in the columns that parse_number_table reads, each row on its line of the file.
struct PlainExport {
  std::string text;
  std::vector<std::string> understood;  ///< a sentence each
};

/// Empty where the text begins with a header that parse_number_table reads, or where no line of the first 200 names a
/// torque beside a time or a speed. Throws RecordError for a column without a unit.
std::optional<PlainExport> plain_export(std::string_view text, const std::string& name);

}  // namespace tremie
