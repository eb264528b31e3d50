#pragma once

// Whether residuals hold more than noise. A smooth curve (polynomials of degree 0 to 5 in the logarithm of time, as the
// first part of a decay is the steep one) is laid through them; what it takes is compared with what it would take of
// noise that is correlated like what it leaves, by an F test. Correlated noise alone, which no better model would
// remove, does not raise the alarm.

#include <span>

namespace tremie {

struct LackOfFit {
  double systematic = 0.0;       ///< root mean square of the smooth part
  double noise = 0.0;            ///< root mean square of what is left
  double correlation = 0.0;      ///< of successive values of what is left
  double probability = 1.0;      ///< that noise alone gives as much
  double roughness_noise = 0.0;  ///< noise by second differences, blind to every smooth curve and every jump
};

/// `x` ascending, `residual` one a reading, both without outliers. Fewer than 8 readings tell nothing: probability 1.
LackOfFit lack_of_fit(std::span<const double> x, std::span<const double> residual);

/// How many independent readings carry as much as n whose residuals correlate: n (1 - rho)/(1 + rho), at most n.
double effective_number(double n, double correlation);

/// Akaike's criterion with its correction for few readings, n ln(mean_square) + 2k + 2k(k + 1)/(n - k - 1), where k
/// counts the parameters and the noise; infinite where n does not exceed k + 1.
double corrected_akaike(double mean_square, double n, int parameters);

}  // namespace tremie
