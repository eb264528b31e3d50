#pragma once

// Torque records of a rheometer as text files: a flow curve (torque at several speeds) or a torque decay
// (torque over time at one speed).

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "rheometer/tables/table.hpp"

namespace tremie {

/// Of an even shear between cylinders (evenly_sheared() in instrument.hpp): the gap by the radius, and the speed [rad/s] at
/// a shear rate of 1 1/s.
inline constexpr double evenly_sheared_gap = 1e-5;
inline const double evenly_sheared_speed = std::log1p(evenly_sheared_gap);

enum class RecordKind { flow_curve, torque_decay };

/// Rows in the order of the file, SI units.
struct TorqueRecord {
  RecordKind kind = RecordKind::flow_curve;
  std::vector<double> omega;              ///< flow curve alone [rad/s], > 0 or = 0
  std::vector<double> time;               ///< torque decay alone [s], not descending
  std::vector<double> torque;             ///< [N m], >= 0
  std::vector<long> line;                 ///< of the file, from 1
  double speed = 0.0;                     ///< of a torque decay whose file has it [rad/s]; 0: not there
  double rest = 0.0;                      ///< before a torque decay, where the file has it [s]; 0: not there
  std::vector<TorqueRecord> flow_curves;  ///< of the same file, where it holds several sections
  bool is_section = false;                ///< of a record with time and speed
  bool sheared_evenly = false;            ///< speed and torque are those of evenly_sheared() (instrument.hpp)
  std::vector<std::string> understood;    ///< how an instrument's export was read, a sentence each
};

/// Reads a record from text (table.hpp): torques over speeds, over time, or both, or what the instrument made of them,
/// shear stresses over shear rates. Of one that has time and speed the first section of constant speed is the decay, and
/// where there is none the first flow curve is it. `name` is the file's, for messages. Throws RecordError for anything
/// else: no rows, a text for a number, an unknown unit, a negative torque or speed, time that runs backwards.
/// `torque_offset` [N m] of the unloaded instrument is taken off first.
TorqueRecord parse_torque_record(std::string_view text, const std::string& name, double torque_offset = 0.0,
                                 const ReadOptions& options = {});

/// The same from a file. Throws RecordError too where it cannot be read.
TorqueRecord read_torque_record(const std::string& path, double torque_offset = 0.0,
                                const ReadOptions& options = {});

/// The table of a torque record with time, speed and torque in the first three columns; `sheared_evenly` where shear
/// rates and stresses stand for them. Of several tables the one that the options say; of those without a time the first,
/// as each is a flow curve of its own. Throws RecordError as above.
NumberTable torque_table(std::string_view text, const std::string& name, double torque_offset,
                         const ReadOptions& options, bool& sheared_evenly);

/// Throws RecordError, with what the header has, where a torque, or both time and speed, or all rows are missing.
void require_kinds(const NumberTable& table, const std::string& name);

/// The text of a file. Throws RecordError where it cannot be read.
std::string read_text_file(const std::string& path);

}  // namespace tremie
