#pragma once

// How fast structure breaks down at several speeds: k and a of the rate_power kinetics, dlambda/dt = -k gamma_dot^a lambda,
// from the times in which the torque loses half of its excess over its end. With time, not strain, as the measure: one
// speed tells k gamma_dot^a, two or more tell a.

#include <optional>
#include <string>
#include <vector>

#include "libmpm/constitutive/rate_power_kinetics.hpp"
#include "rheometer/fits/fit.hpp"
#include "rheometer/records/sections.hpp"

namespace tremie {

/// Torque of a section from its peak on, at one speed.
struct Fall {
  double omega = 0.0;          ///< [rad/s]
  std::vector<double> time;    ///< since the peak [s]
  std::vector<double> torque;  ///< [N m]
  std::size_t section = 0;     ///< its number, from 1
};

struct BreakdownTime {
  std::size_t section = 0;
  double omega = 0.0, rate = 0.0;  ///< [rad/s]; shear rate at the vane of a Newtonian fluid [1/s]
  double half_time = 0.0;          ///< until half of the torque's excess over its end is lost [s]
};

struct Breakdown {
  std::vector<BreakdownTime> times;
  std::optional<ParameterEstimate> rate;      ///< k [1/s]
  std::optional<ParameterEstimate> exponent;  ///< a; empty: a note says why
  /// Of the fastest section: a gamma distribution of rates, T_end + C (1 + t/t_0)^-m, as modes about its half time. Empty
  /// where its shape is not told.
  std::vector<BreakdownMode> modes;
  std::vector<std::string> notes;
};

/// The time [s] in which the torque loses half of its excess over the mean of its last twentieth; empty where it falls by
/// less than a tenth of its peak.
std::optional<double> excess_half_time(const Fall& fall);

/// At most six modes of the gamma distribution of rates whose Laplace transform is (1 + t/t_0)^-m, factors on `rate` [1/s];
/// m and t_0 > 0. Their sum is within 0.03 of it until 100/rate.
std::vector<BreakdownMode> modes_of_gamma(double m, double t_0, double rate);

/// k and a of several falls; `modes` is left to who knows a fall's shape.
Breakdown breakdown_of(const std::vector<Fall>& falls, const Instrument& instrument);

/// Peaks over rests as structure that saturates: S_end - C e^(-rest/t). In the terms of a scene A_thix = (S_end - tau_0)/t
/// and lambda_max = (S_end - tau_0)/tau_0.
struct Saturation {
  double end_stress = 0.0;  ///< S_end [Pa]
  double time = 0.0;        ///< t [s]
  double scatter = 0.0;     ///< relative to the mean stress
  double chance = 1.0;      ///< of so much less scatter than a line's, were the line right (F test)
  std::optional<double> forecast_of_longest;  ///< by the shorter rests alone [Pa]
};

/// Empty for fewer than four rests, or where the peaks do not bend down.
std::optional<Saturation> saturation_of(const std::vector<double>& rest, const std::vector<double>& stress);

}  // namespace tremie
