#pragma once

#include <optional>

#include "libmpm/constitutive/flocculation.hpp"

namespace tremie {

/// A fresh concrete as a continuum, SI units.
struct Mix {
  double density = 2400.0;  ///< rho [kg/m^3]
  double tau_0 = 0.0;       ///< dynamic yield stress [Pa]
  double mu = 0.0;          ///< plastic viscosity [Pa s]
  double K = 1e6;           ///< bulk modulus [Pa]
  double G = 0.0;           ///< shear modulus below the yield stress [Pa]; 0: rigid, as every flow has it
  std::optional<Thixotropy> thixotropy;
};

/// Numbers of the flocculation state that a point of the mix stores: its value, and its parts where the kinetics has modes.
inline std::size_t lambda_numbers(const Mix& mix) {
  return mix.thixotropy ? 1 + part_shares(mix.thixotropy->kinetics).size() : 0;
}

}  // namespace tremie
