#pragma once

// Velocity gradients to strain rates and stresses to tractions, in each space: the rows of geometries.hpp summed
// over a stencil, for one number or many at a time. T: double or f64x8.

#include <type_traits>

#include "libmpm/geometry/geometries.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie {

/// Strain-rate vector q and divergence from L[a][b] = dv_a/dx_b [1/s]; v_0 and x_0 are the first components
/// of velocity and place, which the hoop rate of the axisymmetric space needs.
template <class Geometry, class T>
void strain_rate_of(const T (&L)[Geometry::dim][Geometry::dim], const T& v_0, const T& x_0,
                    T (&q)[Geometry::n_strain], T& divergence) {
  constexpr double one_over_sqrt3 = inv_sqrt3;
  T third = {};  // rate of extension along the third direction
  if constexpr (std::is_same_v<Geometry, Axisymmetric>) third = v_0 / x_0;
  if constexpr (Geometry::dim == 3) third = L[2][2];
  q[0] = L[0][0] - L[1][1];
  q[1] = (L[0][0] + L[1][1] - 2.0 * third) * one_over_sqrt3;
  q[2] = L[0][1] + L[1][0];
  if constexpr (Geometry::dim == 3) q[3] = L[1][2] + L[2][1], q[4] = L[0][2] + L[2][0];
  divergence = L[0][0] + L[1][1] + third;
}

/// Stress tensor in the space's plane and hoop stress from the deviatoric stress vector s and a pressure
/// [Pa].
template <class Geometry, class T>
void stress_tensor_of(const T (&s)[Geometry::n_strain], const T& pressure,
                      T (&sigma)[Geometry::dim][Geometry::dim], T& hoop) {
  constexpr double one_over_sqrt3 = inv_sqrt3;
  sigma[0][0] = s[0] + s[1] * one_over_sqrt3 - pressure;
  sigma[1][1] = s[1] * one_over_sqrt3 - s[0] - pressure;
  sigma[0][1] = sigma[1][0] = s[2];
  hoop = -2 * one_over_sqrt3 * s[1] - pressure;
  if constexpr (Geometry::dim == 3) {
    sigma[2][2] = hoop;
    sigma[1][2] = sigma[2][1] = s[3];
    sigma[0][2] = sigma[2][0] = s[4];
  }
}

}  // namespace tremie
