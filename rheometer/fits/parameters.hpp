#pragma once

// The parameters that a fit may tell, a row each: the one table that results, means over records, the lines of the
// screen and the pages read.

#include <optional>
#include <string>
#include <vector>

#include "rheometer/fits/fit.hpp"

namespace tremie {

struct FitParameter {
  std::string name;    ///< "yield_stress"
  std::string unit;    ///< "Pa s"; empty for a pure number
  std::string key;     ///< of summary.json: "yield_stress_Pa"
  std::string label;   ///< on the screen: "yield stress"
  std::string words;   ///< on a page: "dynamic yield stress"
  std::string symbol;  ///< "tau_0"
  /// Where its estimate is; null for a parameter of a flow curve's law alone (FitResult::of_law).
  std::optional<ParameterEstimate> FitResult::*member = nullptr;
  /// Relative scatter of one paste between laboratories (Haist et al. 2020, doi 10.1617/s11527-020-01477-w), where known.
  std::optional<double> laboratories = {};
};

/// Those of every record, then those of the flow curve's laws and of an interface.
const std::vector<FitParameter>& fit_parameters();

/// The model of a tribometer's fit and its parameters, tau_i [Pa] and k_i [Pa s/m].
inline constexpr const char* interface_model = "interface";
const std::vector<FitParameter>& interface_parameters();

const FitParameter& yield_stress_parameter();
const FitParameter& plastic_viscosity_parameter();

/// What the fit tells of a parameter; empty: it is not identifiable, or none of the record's model.
std::optional<ParameterEstimate> value_of(const FitResult& fit, const FitParameter& parameter);

/// The parameters of the record's model: the law's of a flow curve, those of a decay without its kinetics' exponent.
std::vector<FitParameter> parameters_of(const FitResult& fit);

void set_value(FitResult& fit, const FitParameter& parameter, const std::optional<ParameterEstimate>& value);

/// The lines of a scene that say the wall of a tribometer's fit: "[walls]\ncontact = ...". Empty where a parameter is not identifiable.
std::string scene_walls(const FitResult& fit);

}  // namespace tremie
