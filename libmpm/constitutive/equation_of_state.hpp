#pragma once

// Weakly compressible equation of state: p = -K ln J, with J = V/V_0 against the stress-free volume.
// Equation (30) of Wilkes, Kumar and Biscontin with the hydrostatic start in J instead of in a carried p_0.

#include <cmath>

namespace tremie {

/// K = E / (3 (1 - 2 nu)), equation (31) [Pa].
inline double bulk_modulus(double youngs_modulus, double poisson_ratio) {
  return youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio));
}

/// Pressure [Pa] of a point with volume ratio J.
inline double pressure(double ln_J, double K) { return -K * ln_J; }

/// ln J of a point that starts under the pressure p [Pa].
inline double ln_J_under(double p, double K) { return -p / K; }

}  // namespace tremie
