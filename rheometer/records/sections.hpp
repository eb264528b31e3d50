#pragma once

// The sections of a record that holds time, speed and torque: rests, start-ups at a low rate, shear at a constant rate,
// flow curves by steps or by a ramp.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "rheometer/records/torque_record.hpp"

namespace tremie {

/// What an instrument wrote of a whole test; SI units, rows in the order of the file.
struct ProtocolRecord {
  std::vector<double> time;    ///< [s], ascending: a clock that starts again with a section is carried on
  std::vector<double> omega;   ///< [rad/s]; magnitudes
  std::vector<double> torque;  ///< [N m], the offset taken off
  std::vector<long> line;
  std::vector<std::size_t> restarts;    ///< rows where the file's clock starts again
  std::vector<std::string> understood;  ///< a sentence each
  bool sheared_evenly = false;          ///< speed and torque are those of evenly_sheared() (instrument.hpp)
};

enum class SectionKind { rest, start_up, constant_rate, flow_curve_up, flow_curve_down, other };

/// Rows [begin, end) of the record.
struct Section {
  SectionKind kind = SectionKind::other;
  std::size_t begin = 0, end = 0;
  double omega = 0.0;        ///< median speed [rad/s]; of a flow curve the highest
  double rest_before = 0.0;  ///< [s]; 0: none
  bool pre_shear = false;    ///< the first shear of several sections, at the highest speed
  bool stepped = false;      ///< flow curve in steps of constant speed
};

/// "rest", "start-up", "constant rate", "flow curve up", ...
std::string_view name_of(SectionKind kind);

/// Reads an export with time, speed and torque. `torque_offset` [N m] of the unloaded instrument is taken off. Throws
/// RecordError for anything else, and for a negative torque in shear.
ProtocolRecord parse_protocol_record(std::string_view text, const std::string& name,
                                     double torque_offset = 0.0, const ReadOptions& options = {});

/// The columns of a table of torque_quantities as they stand, time carried on and speeds without their sign.
ProtocolRecord protocol_of(const NumberTable& table);

/// Sections in the order of time that cover all rows. In a rest the instrument stands still, slower than 5e-4 of
/// the highest speed, and holds no torque; a speed is constant
/// within 3 %; rows in which the vane gathers speed belong to what follows.
std::vector<Section> find_sections(const ProtocolRecord& record);

/// The row of the largest torque while the vane gathers speed or up to a tenth of the section: there a decay begins.
std::size_t peak_of(const ProtocolRecord& record, const Section& section);

/// The section from its peak on, time from there.
TorqueRecord decay_of(const ProtocolRecord& record, const Section& section);

/// Rows of a ramp; of steps the mean of the last half of each.
TorqueRecord flow_curve_of(const ProtocolRecord& record, const Section& section);

}  // namespace tremie
