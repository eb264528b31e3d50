#pragma once

// The elastic cell (elastic_cell.hpp) as an ordinary differential equation, integrated by SUNDIALS CVODE: the reference for
// its return map, which it does not call. Bingham or Herschel-Bulkley:
//
//   d tau/dt = G (gamma_dot - gamma_p),   gamma_p = ((tau - (1 + lambda) tau_0)/k)^(1/n) where that is positive, else 0,
//
// and lambda by kinetics_equations.hpp with gamma_p for its shear rate. The integration starts anew where the stress passes
// the yield stress and where gamma_p passes the gate.

#include <optional>
#include <span>
#include <vector>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/records/shear_history.hpp"
#include "rheometer/reference/couette_flow.hpp"

namespace tremie {

struct ElasticMaterial {
  HerschelBulkleyFluid fluid;  ///< tau_0 > 0
  double G = 0.0;              ///< > 0 [Pa]
  std::optional<Thixotropy> thixotropy = {};
};

struct ElasticOdeResult {
  std::vector<double> stress, lambda;  ///< at the times asked for [Pa]
};

/// From no stress and lambda_0 at time 0; `times` [s] ascend between 0 and the history's duration. Throws
/// std::invalid_argument for parameters out of range, std::runtime_error where CVODE gives up.
ElasticOdeResult elastic_ode(std::span<const ShearPiece> history, const ElasticMaterial& material,
                             double lambda_0, std::span<const double> times);

}  // namespace tremie
