#pragma once

// How fast structure breaks down: k and a of the rate_power kinetics, dlambda/dt = -k gamma_dot^a lambda, and its modes, from
// one least squares through all falls of a record, at all speeds and after all rests (joint_fall_fit.hpp). One speed tells
// k gamma_dot^a, two or more tell a.

#include <optional>
#include <string>
#include <vector>

#include "libmpm/constitutive/rate_power_kinetics.hpp"
#include "rheometer/fits/fit.hpp"
#include "rheometer/protocol/falls.hpp"

namespace tremie {

struct BreakdownTime {
  std::size_t section = 0;
  double omega = 0.0,
         rate = 0.0;  ///< [rad/s]; shear rate at the vane of a Newtonian fluid, plastic if asked for [1/s]
  double half_time = 0.0;  ///< until half of the torque's excess over its end is lost, from the peak on [s]
  double onset = 0.0;      ///< from the peak until the fit begins [s] (onset_of)
  std::optional<double> breakdown_rate;    ///< of the first mode, by the joint fit [1/s]
  std::optional<double> half_time_by_law;  ///< the half time of the torque that k, a and the modes give [s]
  std::optional<double> scatter;           ///< of its readings about the joint fit, relative
};

struct Breakdown {
  std::vector<BreakdownTime> times;
  /// k [1/s]; with modes that of the largest share, whose factor is 1.
  std::optional<ParameterEstimate> rate;
  std::optional<ParameterEstimate> exponent;  ///< a; empty: a note says why
  std::vector<BreakdownMode> modes;           ///< common to all falls, factors on k; empty for one
  /// Kinetics that were compared over all falls; none where the falls tell no exponent.
  std::vector<Candidate> candidates;
  std::string choice;
  std::vector<std::string> notes;
};

/// k, a and the modes of several falls. `compare`: the kinetics are compared by their fits as well.
Breakdown breakdown_of(const std::vector<Fall>& falls, const Instrument& instrument, bool compare = true);

}  // namespace tremie
