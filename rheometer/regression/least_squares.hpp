#pragma once

// Robust nonlinear least squares with a covariance, for readings whose error is in proportion to their size.
//
// Three passes: (1) Ceres with a Cauchy loss on (observed - fitted)/fitted, the scale from the residuals'
// median; (2) outliers named by a test of known level (Rosner's generalised extreme Studentised deviate for
// few readings, a cut at the 0.5 % family level of a normal sample for many); (3) plain least squares on what
// is left, whose covariance is then honest.

#include <functional>
#include <span>
#include <vector>

namespace tremie {

struct LeastSquaresProblem {
  /// Fills `fitted` (one a reading) and, where it is not empty, `jacobian` (readings x parameters, row by
  /// row). False where the model has no value for these parameters.
  std::function<bool(std::span<const double> parameters, std::span<double> fitted,
                     std::span<double> jacobian)>
      model;
  std::vector<double> observed;  ///< > 0
  std::vector<double> count;     ///< how many readings each is the mean of
  std::vector<double> start, lower, upper;
};

struct LeastSquaresFit {
  std::vector<double> parameters;
  std::vector<double> fitted, residual;  ///< of all readings; residual = (observed - fitted)/fitted
  std::vector<char> outlier;
  double scatter = 0.0;            ///< relative standard deviation of one reading
  double degrees_of_freedom = 0;   ///< independent readings left - parameters; 0: no uncertainty can be told
  std::vector<char> told;          ///< parameters that the readings tell apart from the others
  std::vector<double> covariance;  ///< parameters x parameters; 0 where a parameter is not told
  double correlation = 0.0;        ///< of successive residuals
  double independent = 0.0;        ///< independent readings that carry as much as those that are no outliers
};

struct LeastSquaresOptions {
  /// Correlated residuals widen the covariance, and neighbours that miss alike are no outliers.
  bool readings_in_time_order = false;
  /// Indices of the readings in the order in which they were taken: correlated residuals widen the covariance. Empty:
  /// that order is not known, or, with readings_in_time_order, the one in which they stand.
  std::vector<std::size_t> taken = {};
  bool find_outliers = true;
  double parameter_tolerance = 1e-10;  ///< relative change of the parameters to stop at
  int max_iterations = 60;
};

/// Throws std::runtime_error where the model has no value at the start.
LeastSquaresFit fit_least_squares(const LeastSquaresProblem& problem,
                                  const LeastSquaresOptions& options = {});

}  // namespace tremie
