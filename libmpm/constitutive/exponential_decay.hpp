#pragma once

// A breakdown in proportion to lambda over a step: exponentials and their means, without loss of digits for any length
// of the step.

#include <algorithm>
#include <cmath>

#include "libmpm/parallel/simd.hpp"

namespace tremie {

namespace detail {

/// What equation (3) needs of a step in which the rate breaks lambda down by e^-k. With u the share of the
/// step that is left and < > the mean weighted by e^-ku:
struct Decay {
  double end;        ///< e^-k
  double mean;       ///< int_0^1 e^-ku du = (1 - e^-k)/k
  double asymmetry;  ///< <u(1 - u)> = (k coth(k/2) - 2)/k^2
  double curvature;  ///< <u(1 - u)(1 - 2u)> = (1 - 6 asymmetry)/k
};

/// All four to rounding, k >= 0. Below 1/2 by e^-k = (P - kQ)/(P + kQ), the Pade approximant of order 12
/// (error 2e-17), in which the differences that cancel are taken by hand.
inline Decay decay(double k) {
  if (k < 0.5) {
    const double x = k * k;
    const double P = 1.0 + x * (5.0 / 44.0 + x * (1.0 / 792.0 + x * (1.0 / 665280.0)));
    const double Q = 0.5 + x * (1.0 / 66.0 + x * (1.0 / 15840.0));
    const double share = 1.0 / (P + k * Q);
    return {(P - k * Q) * share, 2.0 * Q * share, (1.0 / 12.0 + x * (1.0 / 880.0 + x * (1.0 / 665280.0))) / Q,
            k * (1.0 / 120.0 + x * (1.0 / 18480.0)) / Q};
  }
  const double end = std::exp(-k), asymmetry = (k * (1.0 + end) / (1.0 - end) - 2.0) / (k * k);
  return {end, (1.0 - end) / k, asymmetry, (1.0 - 6.0 * asymmetry) / k};
}

/// e^-z; where z is small, as it is in a step that resolves the history, by a Pade approximant (error 1e-13).
inline double exp_of_small(double z) {
  if (std::abs(z) > 0.01) return std::exp(-z);
  const double even_part = 1.0 + z * z / 12.0;
  return (even_part - 0.5 * z) / (even_part + 0.5 * z);
}

/// lambda after a step of equation (3): what is left of it, and what was built up meanwhile and is left,
/// A dt int_0^1 exp(-ku - z(u)) du with the mean <z> in place of z(u): an error of second order in z alone.
/// The integral is at most 1 because no rate is negative.
inline double build_and_break(double lambda, double build_rate, const Decay& d, double z, double dt) {
  return lambda * d.end + build_rate * dt * std::min(1.0, d.mean * exp_of_small(z));
}

}  // namespace detail

/// detail::Decay::asymmetry of points side by side: (k coth(k/2) - 2)/k^2, by its series (error 1e-15) below
/// 1/2. `d` is mean_decay(k).
inline f64x8 decay_asymmetry(const f64x8& k, const f64x8& d) {
  const f64x8 ones = all_lanes(1.0), x = k * k;
  const i64x8 small = k < 0.5;
  const f64x8 far = (2.0 * (ones - d) / d - k) / select(small, ones, x);
  const f64x8 near =
      1.0 / 6.0 -
      x * (1.0 / 360.0 - x * (1.0 / 15120.0 -
                              x * (1.0 / 604800.0 - x * (1.0 / 23950080.0 - x * (691.0 / 653837184000.0)))));
  return select(small, near, far);
}

}  // namespace tremie
