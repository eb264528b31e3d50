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

/// Fits with in.kinetics on 100 intervals of the gap. Throws std::runtime_error where the model has no solution.
DecayFit fit_decay(const Readings& r, const FitInput& in);

/// The same fit, continued on another number of intervals.
DecayFit refined(const Readings& r, const FitInput& in, DecayFit fit, int intervals);

}  // namespace tremie::fitting
