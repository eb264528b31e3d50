#pragma once

// The torque of the thixotropic Couette model at the times of a record, and its derivatives. Private to
// rheometer/.

#include <array>
#include <span>
#include <vector>

#include "rheometer/fits/fit.hpp"

namespace tremie::fitting {

/// tau_0 [Pa], mu [Pa s], lambda_0, alpha lambda_0^(n-1), n. The fourth is the breakdown at the start: with it the
/// fall of the first torque fixes one parameter whatever n; it is alpha itself where n = 1. n counts for kinetics with a
/// free exponent alone.
using DecayParameters = std::array<double, 5>;

/// alpha of the law from the fourth parameter.
double alpha_of(const DecayParameters& p);

/// n of mu gamma_dot^n, by the flow curve that the input knows; 1 without one.
double flow_index_of(const FitInput& in);

/// The kinetics of in.kinetics with these parameters; A_thix from the rest, 0 where it is not known.
Thixotropy thixotropy_of(const DecayParameters& p, const FitInput& in);

/// Solves the model on a fixed set of times, dense at the start, and interpolates to those of the record: one
/// solve serves a record of any length.
class DecayModel {
 public:
  /// `intervals` of the model in r (CouetteOptions).
  DecayModel(const FitInput& input, const std::vector<double>& times, int intervals);

  /// Torque [N m] at the times of the record. Throws std::runtime_error where the integrator gives up.
  void torque(const DecayParameters& p, std::span<double> result) const;

 private:
  struct Place {
    std::size_t interval;
    std::array<double, 4> weight;  ///< of the torque and the slope at both ends (cubic Hermite)
  };

  FitInput input_;
  int intervals_;
  std::vector<double> nodes_;
  std::vector<Place> places_;
};

/// The yield stress [Pa] with which a material of the viscous stress mu gamma_dot^n gives this torque at the input's
/// speed; 0 where the viscous stress alone gives more.
double yield_stress_from_torque(double torque, double mu, const FitInput& in);

}  // namespace tremie::fitting
