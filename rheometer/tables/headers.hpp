#pragma once

// Which lines of a text head a table of numbers, and what their columns are. Private to rheometer/tables.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rheometer/tables/column_names.hpp"
#include "rheometer/tables/fields.hpp"
#include "rheometer/tables/table.hpp"

namespace tremie::detail {

/// A blank line, or one of a comment.
bool carries_nothing(std::string_view line);

/// Where each quantity stands in a table.
struct Header {
  std::size_t at = 0;  ///< index of the line
  char separator = ',';
  std::vector<std::string> fields;
  std::vector<std::optional<NamedColumn>> column;  ///< of each quantity
  std::vector<std::size_t> index;                  ///< of the field, from 0
  std::size_t named = 0;                           ///< how many are there
  bool plain = true;                               ///< English names with units, which leave nothing to tell
  std::optional<std::size_t> doubled = {};  ///< field of a second column of a quantity, as good as the first
  std::size_t doubled_quantity = 0;
  std::vector<std::size_t> moduli = {};  ///< fields that only an oscillation fills
  std::vector<std::size_t> groups = {};  ///< fields that tell samples, ramps or runs apart

  bool has(std::size_t q) const { return column[q].has_value(); }
};

/// Finds headers among the lines of a file.
struct Headers {
  const std::vector<TextLine>& lines;
  const std::vector<ColumnQuantity>& quantities;
  const ColumnSets& sets;
  std::vector<GivenColumn> given;

  /// The columns that the fields name, or that the user gives.
  Header columns_of(std::vector<std::string> fields, std::size_t at, char separator) const;
  /// A header names two quantities or more; the first separator by which a line does is taken.
  std::optional<Header> header_at(std::size_t at) const;
  /// The first line that names a set of columns above rows of numbers; else the first that names two quantities.
  std::optional<Header> first_header() const;
  /// The header of a further table, if the line is one.
  std::optional<Header> next_header(std::size_t at) const;
  /// Whether a line begins a table of other columns, as a step of an oscillation does: two texts or more, none of them a unit of
  /// the header's columns, with numbers or units below. Without a unit of its own it stands behind a gap and has half as many
  /// fields as the header or more.
  bool heads_other_columns(const Header& h, const std::vector<std::string>& fields, std::size_t at,
                           bool behind_a_gap) const;
  /// Keeps the first of the sets that the header has; the quantities outside of it are no columns.
  void keep_a_set(Header& h) const;
  /// Takes units from one of the three lines below the header; the line behind the last one that has some.
  std::size_t find_units(Header& h) const;
  /// Whether one of the five lines below has a number in the field.
  bool has_numbers(const Header& h, std::size_t field) const;
  /// "shear_rate=1 [unit]; shear_stress=2 [unit]": what is missing, for the user to fill in.
  std::string columns_without_units(const Header& h) const;

 private:
  std::string unit_within(const std::string& field, std::size_t q) const;
  void take(Header& h, const NamedColumn& named, std::size_t i) const;
  bool all_have_units(const Header& h) const;
  bool has_a_set(const Header& h) const;
  bool has_rows(const Header& h) const;
  std::optional<Header> numbered_header() const;
};

}  // namespace tremie::detail
