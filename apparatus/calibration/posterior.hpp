#pragma once

// The posterior over the unknowns on weighted points: a grid for one or two unknowns, a Sobol sequence for
// more.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "apparatus/calibration/emulator.hpp"

namespace tremie::calibration {

struct Posterior {
  std::vector<Point> points;
  std::vector<double> weights;  ///< their sum is 1
  std::size_t best = 0;         ///< the point of the largest weight
};

/// Points over the unit cube, each for the same share of its volume.
std::vector<Point> quadrature_points(std::size_t unknowns);

/// Weights from logarithms of the likelihood.
Posterior make_posterior(std::vector<Point> points, const std::vector<double>& log_likelihood);

/// The share below which `q` of the weight lies, of one unknown; linear between points.
double quantile(const Posterior& posterior, std::size_t unknown, double q);

/// As many points of equal weight as would say as much.
double effective_points(const Posterior& posterior);

/// The value below which `q` of the posterior's weight lies, each point a Gaussian.
double mixture_quantile(const Posterior& posterior, const std::vector<Prediction>& predictions, double q);

/// Logarithm of the likelihood of a measurement (its value and standard error) where a run is predicted, whose cells and steps
/// are good to `cells`; the constant is left out.
double log_likelihood(double value, double error, const Prediction& run, double cells);

/// "identified": the interval is less than half of the range, and off both of its ends. "not_told": it is more
/// than four fifths of the range. "bound": neither.
std::string told(double low, double high);

}  // namespace tremie::calibration
