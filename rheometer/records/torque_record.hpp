#pragma once

// Torque records of a rheometer as text files: a flow curve (torque at several speeds) or a torque decay
// (torque over time at one speed).

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tremie {

enum class RecordKind { flow_curve, torque_decay };

/// Rows in the order of the file, SI units.
struct TorqueRecord {
  RecordKind kind = RecordKind::flow_curve;
  std::vector<double> omega;            ///< flow curve alone [rad/s], > 0 or = 0
  std::vector<double> time;             ///< torque decay alone [s], not descending
  std::vector<double> torque;           ///< [N m], >= 0
  std::vector<long> line;               ///< of the file, from 1
  double speed = 0.0;                   ///< of a torque decay whose file has it [rad/s]; 0: not there
  std::vector<std::string> understood;  ///< how an instrument's export was read, a sentence each
};

/// A fault of a record: "name:line:column: what is wrong; what is allowed".
struct RecordError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads a record from text. An instrument's export (instrument_export.hpp) is taken as it is; of one that has time,
/// speed and torque the first section of constant speed is the decay. The header names the columns and their units: speed_rev_per_s, speed_rpm,
/// speed_rad_per_s, time_s, time_ms, time_min, torque_N_m, torque_mN_m, ..., also as "torque (mN·m)"; other
/// columns are left out. Separator comma, semicolon or tab; with the last two a decimal comma too. Lines from
/// # on are comments; a byte-order mark is skipped. `name` is the file's, for messages. Throws RecordError
/// for anything else: no rows, a text for a number, too few columns, an unknown unit, a negative torque or
/// speed, time that runs backwards. `torque_offset` [N m] of the unloaded instrument is taken off first.
TorqueRecord parse_torque_record(std::string_view text, const std::string& name, double torque_offset = 0.0);

/// The same from a file. Throws RecordError too where it cannot be read.
TorqueRecord read_torque_record(const std::string& path, double torque_offset = 0.0);

/// The text of a file. Throws RecordError where it cannot be read.
std::string read_text_file(const std::string& path);

}  // namespace tremie
