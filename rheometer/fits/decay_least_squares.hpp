#pragma once

// The least squares of the thixotropic Couette model to a torque decay. Private to rheometer/.

#include <span>
#include <vector>

#include "rheometer/fits/decay_model.hpp"
#include "rheometer/fits/fit_common.hpp"
#include "rheometer/regression/least_squares.hpp"

namespace tremie::fitting {

enum Index : std::size_t { i_tau_0, i_mu, i_lambda, i_alpha, i_exponent };

/// Mean torque over the first or last part of the readings, as shares of their number.
double mean_torque(const Readings& r, double from, double to);

/// Which of the parameters are free, and how a vector of those maps to all of them.
struct Layout {
  std::vector<std::size_t> free;
  DecayParameters all{};

  DecayParameters with(std::span<const double> p) const {
    DecayParameters result = all;
    for (std::size_t k = 0; k < free.size(); ++k) result[free[k]] = p[k];
    return result;
  }
};

struct DecayFit {
  Kinetics kinetics = {};
  Layout layout;
  LeastSquaresFit fit;

  DecayParameters parameters() const { return layout.with(fit.parameters); }
};

/// Intervals of the gap: 100, and 400 for another flow index than 1, by which the edge of a thinner layer counts for more.
int intervals_of(const FitInput& in);

/// Fits with in.kinetics on intervals_of(in). Throws std::runtime_error where the model has no solution.
DecayFit fit_decay(const Readings& r, const FitInput& in);

/// The same fit, continued on another number of intervals.
DecayFit refined(const Readings& r, const FitInput& in, DecayFit fit, int intervals);

/// What the flow curve's covariance adds to that of all parameters: their moves as the law moves along the columns of its
/// Cholesky factor, one standard deviation each. Empty without a flow curve that knows it.
std::vector<DecayParameters> moves_by_curve(const Readings& r, const FitInput& in, const DecayFit& fit);

}  // namespace tremie::fitting
