#pragma once

// A law from which the fit of a flow curve chooses: what it states, and the registry of all. A law is a file in laws/ and
// a place in the list of flow_laws.cpp there; fits, their results, the command's and Python's options name none.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rheometer/fits/parameters.hpp"

namespace tremie {

/// Stress beyond the yield stress: k gamma_dot^n [Pa]. Of Bingham k is the plastic viscosity and n = 1.
struct ViscousStress {
  double k = 0.0, n = 1.0;
};

/// Torque at a speed, and its derivatives by the law's parameters in their order.
struct FlowTorque {
  double torque = 0.0;          ///< [N m]
  double sheared_radius = 0.0;  ///< [m]; R_o where all is sheared
  std::array<double, 3> slope{};
};

/// The largest value of a parameter that has no largest one.
inline constexpr double no_upper_bound = 1e9;

struct LawParameter {
  FitParameter row;
  double lower = 0.0, upper = no_upper_bound;
  /// A range that is the law's own: at an end of it the law does not describe the record.
  bool has_range() const { return upper < no_upper_bound; }
};

struct FlowLaw {
  std::string name;   ///< "herschel_bulkley"
  std::string words;  ///< "Herschel-Bulkley"
  std::string line;   ///< of the fitted torques, for a chart: "Herschel-Bulkley in the gap"
  std::vector<LawParameter> parameters;  ///< the yield stress first, three at most
  /// Of a law without a plastic viscosity, what it has in its place: a note of every fit.
  std::string in_place_of_viscosity;
  /// Parameters to start from, near the Bingham material that fits.
  std::vector<double> (*start)(const Bingham& bingham);
  FlowTorque (*torque)(std::span<const double> parameters, double omega, const Instrument& instrument);
  /// Shear rate [1/s] at which the material carries `above` [Pa] more than its yield stress; empty where it has none.
  std::optional<double> (*rate)(std::span<const double> parameters, double above);
  /// What a decay of the same material takes of the law; null for one of another form, whose decays are refused.
  ViscousStress (*viscous)(std::span<const double> parameters);
  /// Speed below which part of the gap is at rest [rad/s]; null where there is no formula.
  std::optional<double> (*plug_below)(std::span<const double> parameters, const Instrument& instrument);
};

/// All laws, the one of fewest parameters first; each of the others contains it, and is taken where it is clearly better.
const std::vector<FlowLaw>& flow_laws();

/// Throws std::invalid_argument for a name that no law has.
const FlowLaw& flow_law(const std::string& name);

/// The law of a fitted flow curve; null for a decay and for an interface.
const FlowLaw* law_of(const FitResult& fit);

/// The law of a fitted flow curve with its parameters, a yield stress of at least 0; empty where the fit is not to be
/// trusted or a parameter is not identifiable.
std::optional<KnownLaw> known_law(const FitResult& fit);

/// Its viscous part. Throws std::invalid_argument for a law of another form.
ViscousStress viscous_stress(const KnownLaw& law);

}  // namespace tremie
