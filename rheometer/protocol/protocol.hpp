#pragma once

// The reading of each section of a whole test: static yield stress and elastic rise of a start-up after a rest, flow
// curve, decay at a constant rate; and A_thix from the peaks after rests of different length.

#include <optional>
#include <string>
#include <vector>

#include "rheometer/fits/fit.hpp"
#include "rheometer/protocol/breakdown.hpp"
#include "rheometer/protocol/saturation.hpp"
#include "rheometer/records/sections.hpp"
#include "rheometer/vane/vane_blades.hpp"

namespace tremie {

/// Start of the shear at a low rate.
struct StartUpReading {
  double peak_torque = 0.0;  ///< [N m]
  double peak_time = 0.0;    ///< since the vane began to turn [s]
  double end_torque = 0.0;   ///< at the end of the section [N m]
  double peak_angle = 0.0;   ///< that the vane has turned by then [rad]
  bool peak_inside = false;  ///< false: the torque still rises at the end, so the peak is a lower bound
  std::optional<double> static_yield_stress;  ///< of the peak [Pa]
  /// The same without the viscous stress at this speed, by the record's flow curve [Pa].
  std::optional<double> static_by_law;
  std::optional<double> rise;           ///< of the torque over the angle up to half the peak [N m/rad]
  std::optional<double> shear_modulus;  ///< of that rise [Pa]
};

/// The shape of a decay behind its peak, without a material: T_end + C e^(-t/t_0) against T_end + C (1 + t/t_0)^(-m).
struct DecayShape {
  double peak_torque = 0.0, end_torque = 0.0;              ///< [N m]
  std::optional<double> half_time;                         ///< from the peak to half of its torque [s]
  std::optional<double> exponential_scatter;               ///< relative
  std::optional<double> power_scatter, power_m, power_t0;  ///< t_0 [s]
};

struct SectionReading {
  Section section;
  long first_line = 0, last_line = 0;
  double start = 0.0, duration = 0.0;  ///< [s]
  std::optional<StartUpReading> start_up;
  std::optional<DecayShape> decay;
  std::optional<FitResult> fit;  ///< decay or flow curve
  /// Of a flow curve down behind one up: between the branches, torque over speed [W], or stress over shear rate [Pa/s].
  std::optional<double> loop_area;
  double fit_origin = 0.0;  ///< time from the start of the section at which a decay's fit begins [s]
  std::vector<std::string> notes, reasons;
};

/// Peaks over rests: static yield stress = intercept + A_thix rest.
struct Structuration {
  std::optional<ParameterEstimate> A_thix, at_no_rest;  ///< [Pa/s], [Pa]
  /// The same line through the stresses without their viscous part, where a flow curve tells it.
  std::optional<ParameterEstimate> A_thix_by_law, at_no_rest_by_law;
  std::optional<double> scatter;      ///< of the peaks about the line, relative to their mean
  std::optional<double> early, late;  ///< slope between the two shortest and the two longest rests [Pa/s]
  std::optional<Saturation> saturation;
  std::vector<PeakForecast> forecasts;
  std::vector<double> rest, stress;  ///< what was used [s], [Pa]
  std::vector<std::string> notes;
};

struct ProtocolReading {
  bool sheared_evenly = false;  ///< of the record
  std::vector<SectionReading> sections;
  std::size_t flow_curve = 0;  ///< number of the section whose law decays and start-ups take; 0: none
  Structuration structuration;
  Breakdown breakdown;
  std::vector<std::string> reasons;  ///< why a section is not to be trusted, with its number
};

struct ProtocolOptions {
  double compliance = 0.0;           ///< of the instrument: its own turn by torque [rad/(N m)]
  bool elastic = false;              ///< breakdown by the plastic shear rates of start-ups (plastic_speed)
  std::optional<BladeTable> blades;  ///< corrects the torques of a vane with four thin blades
};

/// The law of a flow curve in a record of sections, alone or among the others: the input's, and all compared where none is
/// given; Bingham's where a plastic viscosity is.
std::string law_of_section(const FitInput& input);

/// "yield_stress, consistency, flow_index".
std::string names_of(const KnownLaw& law);

/// Reads every section; decays and start-ups by the law of the record's last flow curve that tells all of its parameters,
/// unless yield stress and viscosity are given. `input` holds instrument, kinetics, law and what is known besides; its
/// speed and rest are the sections'. With blades every section is read by the torques of the cylinder that they span, by
/// Bingham's law; one that cannot be has a reason. Throws std::invalid_argument for an instrument that cannot be, and as
/// blade_factor() does.
ProtocolReading read_protocol(const ProtocolRecord& record, const FitInput& input,
                              const ProtocolOptions& options = {});

/// The yield stress [Pa] with which a material of this law otherwise gives the torque at the speed; empty for a law
/// without a viscous part.
std::optional<double> static_yield_stress_of(const KnownLaw& law, double torque, double omega,
                                             const Instrument& instrument);

/// The shape of a torque from its peak on; time counts from the peak.
DecayShape read_decay_shape(const std::vector<double>& time, const std::vector<double>& torque);

/// The loop of a flow curve down behind one up.
void read_loop(const ProtocolRecord& record, const SectionReading& before, SectionReading& reading);

/// A start-up: rows of the section; the static yield stress is that of the torque as it stands.
StartUpReading read_start_up(const ProtocolRecord& record, const Section& section,
                             const Instrument& instrument, const ProtocolOptions& options,
                             std::vector<std::string>& notes);

/// The line through the peaks of the start-ups whose peak lies inside.
Structuration structuration_of(const std::vector<SectionReading>& sections);

}  // namespace tremie
