#pragma once

// Draws from a posterior of three unknowns and more: Markov chains by OpenTURNS' random-walk Metropolis-Hastings.

#include <functional>

#include "apparatus/calibration/posterior.hpp"

namespace tremie::calibration {

struct Chains {
  std::vector<Point> points;  ///< of all chains, burn-in left out, thinned
  double r_hat =
      0.0;  ///< the largest over unknowns, of halves of chains (Gelman and others, 2013); 1: converged
  double effective = 0.0;  ///< the fewest independent draws that would say as much, over unknowns
};

/// Chains from points of a first posterior, with its covariance for steps. `log_likelihood` over the unit cube.
Chains sample(const Posterior& first, const std::function<double(const Point&)>& log_likelihood);

/// R-hat of one unknown: sqrt(((n - 1)/n W + B/n)/W), B and W the variance between and within half chains of n draws.
double r_hat(const std::vector<std::vector<double>>& chains);

/// Independent draws: all of them over 1 + 2 sum of autocorrelations, summed in pairs until a pair is negative (Geyer).
double effective_draws(const std::vector<std::vector<double>>& chains);

}  // namespace tremie::calibration
