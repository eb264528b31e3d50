#pragma once

// What the header of a column says: which quantity, in which unit. Private to rheometer/records.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rheometer/tables/table.hpp"

namespace tremie::detail {

/// Lower case, "per" as "/", micro as "u", without blanks, brackets, underscores and multiplication signs; exponents as
/// "-1". "MPa" is "megapa", as "mPa" is "mpa".
std::string normal_unit(std::string_view text);

/// The factor to SI of a unit of the quantity; empty for another unit.
std::optional<double> factor_of(const ColumnQuantity& quantity, std::string_view unit);

struct NamedColumn {
  std::size_t quantity = 0;
  std::size_t rank = 0;       ///< of the name among the quantity's, the best first
  std::string unit;           ///< as it stands in the header; empty for none
  bool unknown_unit = false;  ///< the unit is none of the quantity's
};

/// What the text of a header names; empty for anything else.
std::optional<NamedColumn> named_column(std::string_view header,
                                        const std::vector<ColumnQuantity>& quantities);

/// Whether a header names a modulus, which an oscillation measures and a rotation does not.
bool is_of_oscillation(std::string_view header);

/// "torque=3", "torque=Kraft am Hebel [N m]" or "torque=mN.m": a column that the user names.
struct GivenColumn {
  std::size_t quantity = 0;
  std::size_t number = 0;  ///< from 1; 0: by name or unit
  std::string name;        ///< of the header, lower case; or a unit that a column has
  std::string exact;       ///< the name as it was written: 't' and 'T' may be two columns
  std::string unit;        ///< what is written behind in brackets; empty for what the header has
};

/// Of a text with ';' or a new line between them. Throws std::invalid_argument for anything else.
std::vector<GivenColumn> given_columns(const std::string& text,
                                       const std::vector<ColumnQuantity>& quantities);

/// Whether the header is the one that is given by name or by unit.
bool is_given(const GivenColumn& given, std::string_view header, const ColumnQuantity& quantity);

}  // namespace tremie::detail
