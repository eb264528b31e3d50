#pragma once

// A column of numbers by number of a small text table: what a torque record and a shear-rate history have in
// common.

#include <string>
#include <string_view>
#include <vector>

namespace tremie {

/// A quantity that a column may hold, and the factors of its units to SI. A unit is written in lower case
/// without spaces and brackets, "per" as "/": "rev/s", "mnm".
struct ColumnQuantity {
  std::string_view name;
  std::vector<std::pair<std::string_view, double>> units;
  std::string_view allowed;  ///< for messages: "time_s, time_ms or time_min"
};

/// Columns that were found, in the order of the quantities asked for; empty where a quantity has no column.
struct NumberTable {
  std::vector<std::vector<double>> column;  ///< SI
  std::vector<std::size_t> position;        ///< column of the file, from 1; 0: not there
  std::vector<long> line;                   ///< of each row
  long header_line = 0;
};

/// Reads the columns of `quantities` from comma-, semicolon- or tab-separated text; see torque_record.hpp for
/// the format. Throws RecordError.
NumberTable parse_number_table(std::string_view text, const std::string& name,
                               const std::vector<ColumnQuantity>& quantities);

/// Time [s], speed [rad/s] and torque [N m], the columns of every torque record, in this order.
const std::vector<ColumnQuantity>& torque_quantities();

/// "name:line:column: what", for RecordError.
std::string at_position(const std::string& name, long line, std::size_t column, const std::string& what);

}  // namespace tremie
