#pragma once

#include <array>
#include <cmath>

namespace tremie {

/// Symmetric 3x3 tensor in the order xx, yy, zz, xy, yz, xz; the shears are tensor components.
using SymmetricTensor = std::array<double, 6>;

/// A : B of two symmetric tensors.
inline double contract(const SymmetricTensor& a, const SymmetricTensor& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

inline SymmetricTensor deviator(SymmetricTensor d) {
  const double mean = (d[0] + d[1] + d[2]) / 3.0;
  for (std::size_t i = 0; i < 3; ++i) d[i] -= mean;
  return d;
}

/// gamma_dot = sqrt(2 D':D') [1/s], equation (28), of the rate of deformation D [1/s].
inline double shear_rate(const SymmetricTensor& rate_of_deformation) {
  const SymmetricTensor d = deviator(rate_of_deformation);
  return std::sqrt(2.0 * contract(d, d));
}

/// Deviatoric stress tau = 2 [mu + s(gamma_dot)] D' [Pa] of a yield law (libmpm/constitutive/laws/yield_law.hpp).
template <class Law>
SymmetricTensor deviatoric_stress(const Law& law, double mu, double tau_y,
                                  const SymmetricTensor& rate_of_deformation) {
  SymmetricTensor tau = deviator(rate_of_deformation);
  const double viscosity = mu + law.secant(shear_rate(rate_of_deformation), tau_y);
  for (double& component : tau) component *= 2.0 * viscosity;
  return tau;
}

}  // namespace tremie
