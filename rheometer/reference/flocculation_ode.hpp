#pragma once

// The flocculation state as an ordinary differential equation, integrated by SUNDIALS CVODE: the reference
// for the per-point updates of libmpm/constitutive, which it does not call. Its right-hand side is that of
// kinetics_equations.hpp.
//
// The gate is a discontinuity of the right-hand side. CVODE's root-finding stops on each crossing of gamma_c
// and the integration starts anew behind it, so that no step straddles one.

#include <span>
#include <vector>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/records/shear_history.hpp"

namespace tremie {

enum class OdeMethod {
  automatic,  ///< BDF where alpha gamma_dot changes lambda on a time much shorter than the piece, else Adams
  adams,
  bdf
};

/// CVODE bounds the error of a step, not of the end: a tenth of the 1e-12 that a reference needs.
struct OdeOptions {
  double relative_tolerance = 1e-13;
  double absolute_tolerance = 1e-15;
  OdeMethod method = OdeMethod::automatic;
};

struct OdeResult {
  std::vector<double> lambda;  ///< at the times asked for
  long steps = 0;              ///< of CVODE
  long evaluations = 0;        ///< of the right-hand side
  int gate_crossings = 0;
  bool used_bdf = false;  ///< in one piece at least
};

/// lambda at `times` [s], ascending, between 0 and the duration of the history; lambda_0 at time 0, tau_0
/// [Pa]. Throws std::invalid_argument for times or parameters out of range, std::runtime_error where CVODE
/// gives up.
OdeResult flocculation_ode(std::span<const ShearPiece> history, const Thixotropy& thixotropy, double tau_0,
                           double lambda_0, std::span<const double> times, const OdeOptions& options = {});

}  // namespace tremie
