#pragma once

// The falls of a record: torque of a decay or of a start-up from its peak on, at one speed. They are what k and a of the
// rate_power kinetics are found from (breakdown.hpp).

#include <cstddef>
#include <optional>
#include <vector>

#include "rheometer/records/sections.hpp"

namespace tremie {

struct Fall {
  double omega = 0.0;          ///< [rad/s]
  std::vector<double> time;    ///< since the peak [s]
  std::vector<double> torque;  ///< [N m]
  std::size_t section = 0;     ///< its number, from 1
  bool start_up = false;       ///< else shear at a constant rate, whose peak is the start of the flow
  /// Elastic turn by torque of the rise before it [rad/(N m)]; 0: not to be taken into account.
  double compliance = 0.0;
};

/// Sections at a constant speed and start-ups whose torque falls behind its peak. Times that the file rounds, so that rows
/// share them, are laid evenly over the section.
std::vector<Fall> falls_of(const ProtocolRecord& record, const std::vector<Section>& sections);

/// The time [s] in which the torque loses half of its excess over the mean of its last twentieth; empty where it falls by
/// less than a tenth of its peak.
std::optional<double> excess_half_time(const Fall& fall);

/// The row from which structure breaks down all over the sheared layer. A start-up's torque bends over its peak while one
/// part after another yields; its fall counts from the first row with 0.7 of the steepest slope, over a third of the half
/// time. 0 for shear at a constant rate and for a fall without a half time.
std::size_t onset_of(const Fall& fall);

/// The mean speed [rad/s] at which the material flows while the excess at the onset falls to its half: the vane's, and the
/// elastic turn that it gives back meanwhile. The vane's where the fall has no compliance.
double plastic_speed(const Fall& fall);

}  // namespace tremie
