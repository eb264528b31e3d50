#pragma once

// What a row of an instrument's table holds. Private to rheometer/tables.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tremie::detail {

/// The fields of a row. A header that begins with a label, "Interval data:", names no column by it: rows that begin with a
/// number and have a field less are those without the label's place.
std::vector<std::string> row_fields(std::string_view line, char separator,
                                    const std::vector<std::string>& header);

bool all_empty(const std::vector<std::string>& fields);

std::size_t count_numbers(const std::vector<std::string>& fields);

/// What programs write where there is no value.
bool is_placeholder(const std::string& field);

/// Whether one of the columns of moduli has a number that is not 0, as the rows of an oscillation do.
bool measures_a_modulus(const std::vector<std::string>& fields, const std::vector<std::size_t>& moduli);

}  // namespace tremie::detail
