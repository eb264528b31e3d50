#pragma once

// One least squares through the falls of a record at all speeds and after all rests. Private to rheometer/protocol.
//
//   T_s(t) = E_g + sum_i C_si exp(-factor_i r_s t)   or   E_g + C_s (1 + (n - 1) c_s^(n-1) r_s t)^(-1/(n-1))
//
// E_g is common to falls of one speed, the factors to all. Each fall has its own amplitudes C_si: what a mode holds when a
// fall begins hangs on the rest and on what the shear before it has left. c_s = C_s over the largest C. The rate r_s [1/s]
// is free for each fall, or k gamma_dot_s^a, a free or 1.

#include <optional>
#include <vector>

#include "libmpm/constitutive/rate_power_kinetics.hpp"
#include "rheometer/protocol/fall_rows.hpp"
#include "rheometer/regression/least_squares.hpp"

namespace tremie {

enum class RateOfFalls { of_each, power, strain };  ///< r_s free; k gamma_dot^a; k gamma_dot

struct FallModel {
  RateOfFalls rate = RateOfFalls::of_each;
  int modes = 1;          ///< 1 to 4
  bool exponent = false;  ///< the power n of lambda in place of modes
};

struct FallFit {
  FallModel model;
  LeastSquaresFit
      fit;  ///< parameters: E_g, C_si by falls, ln r_s or ln k and a, ln factor_i of i > 1 or n - 1
  std::vector<double> scatter;  ///< of each fall, relative

  std::size_t speeds = 0, first_of_rate = 0, first_of_shape = 0;
};

/// Each fall weighs by 1/scatter^2 where `scatter` has one for each. `start`: a fit with as many modes or one
/// less, whose rates may follow another law.
/// Empty where the least squares have no solution.
std::optional<FallFit> fit_falls(const FallRows& rows, const FallModel& model,
                                 const std::vector<double>& scatter, const FallFit* start = nullptr);

/// Whether the rows tell each rate and each mode: factors three apart at least, shares of two per cent.
bool tells_shape(const FallFit& fit);

/// Mean of the squares of weight times relative residual over the rows that are not left out.
double mean_square(const FallRows& rows, const FallFit& fit, const std::vector<double>& scatter,
                   const std::vector<char>& left_out);

/// Shares of all falls' amplitudes, and factors on r_s.
std::vector<BreakdownMode> modes_of(const FallFit& fit);

/// The fitted torque of fall s at a time after its onset, at the rate r [1/s].
double fitted_torque(const FallRows& rows, const FallFit& fit, std::size_t s, double time, double rate);

}  // namespace tremie
