#pragma once

// Columns of numbers in the text tables that instruments and people write: any separator, decimal mark and order, text
// before and between tables, units in the header or below it, names in several languages or by the user's word. What a
// torque record and a shear-rate history have in common.

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tremie {

/// A fault of a record: "name:line:column: what is wrong; what is allowed".
struct RecordError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A quantity that a column may hold, and the factors of its units to SI. A unit is written in lower case
/// without spaces and brackets, "per" as "/": "rev/s", "mnm".
struct ColumnQuantity {
  std::string_view name;
  std::vector<std::pair<std::string_view, double>> units;
  std::string_view allowed;  ///< for messages: "time_s, time_ms or time_min"
  std::vector<std::string_view> names =
      {};  ///< others, lower case, the best first; "rpm=rpm" implies its unit
};

/// What the user says of a record's text.
struct ReadOptions {
  std::string columns;           ///< "torque=3; speed=Drehzahl [rpm]"; empty: by their names
  std::string decimal = "auto";  ///< or "point", "comma"
  std::size_t table = 0;         ///< of a file with several, from 1; 0: see torque_table()
  bool shear_first = false;      ///< shear rate and stress are taken where speed and torque are there too: no
                                 ///< geometry is given, and readings of a spring are refused
  std::optional<double> torque_per_degree;  ///< of a dial [N m]
  std::optional<double> full_scale_torque;  ///< of readings in % [N m]
  /// Of the geometry, in place of its radii: shear stress by torque [Pa/(N m)], shear rate by speed [1/s by rad/s].
  std::optional<double> stress_constant, strain_constant;
};

/// Columns that were found, in the order of the quantities asked for; empty where a quantity has no column.
struct NumberTable {
  std::vector<std::vector<double>> column;  ///< SI
  std::vector<std::size_t> position;        ///< column of the file, from 1; 0: not there
  std::vector<long> line;                   ///< of each row
  std::vector<std::size_t> starts;          ///< first row of each table of the file
  bool grouped = false;                     ///< samples under one header are tables, with or without a time
  bool chosen = false;                      ///< the table that the options name is the only one here
  long header_line = 0;
  std::vector<std::string> header;      ///< what stands there
  std::size_t left_out = 0;             ///< rows in which a number is missing
  bool of_oscillation = false;          ///< a column of the header is a modulus, as an oscillation measures
  std::vector<std::string> understood;  ///< a sentence each; none of a table that needs no word
};

/// Sets of quantities, by their places, of which the first that a header names whole is read; without any all are read.
using ColumnSets = std::vector<std::vector<std::size_t>>;

/// Reads the columns of `quantities`. Throws RecordError, "name:line:column: what", for a text in place of a number, two
/// readings of a number, a column without a unit or with an unknown one, two columns of one quantity. A text without a
/// header has no columns.
NumberTable parse_number_table(std::string_view text, const std::string& name,
                               const std::vector<ColumnQuantity>& quantities, const ReadOptions& options = {},
                               const ColumnSets& sets = {});

enum TorqueQuantity : std::size_t { q_time, q_speed, q_torque, q_shear_rate, q_shear_stress, q_viscosity };

/// Time [s], speed [rad/s], torque [N m], shear rate [1/s], shear stress [Pa] and viscosity [Pa s], the columns of every
/// torque record, in the order of TorqueQuantity.
const std::vector<ColumnQuantity>& torque_quantities();

/// The columns of a torque record, of its text as decoded_text() has it.
NumberTable parse_torque_table(std::string_view text, const std::string& name, const ReadOptions& options);

/// The text as UTF-8 without a byte-order mark. Throws RecordError for what is no text: a workbook, a picture.
std::string decoded_text(std::string_view bytes, const std::string& name);

/// "name:line:column: what", for RecordError.
std::string at_position(const std::string& name, long line, std::size_t column, const std::string& what);

}  // namespace tremie
