#pragma once

// The few statistics that a fit's confidence intervals and outlier tests need.

#include <vector>

namespace tremie {

/// P(F > f) of Fisher's distribution with d1 and d2 > 0 degrees of freedom.
double fisher_tail(double f, double d1, double d2);

/// The t with P(T <= t) = probability, 0 < probability < 1, of Student's distribution with `degrees` > 0.
double student_quantile(double probability, double degrees);

/// Median; 0 for an empty vector.
double median(std::vector<double> values);

/// Robust estimate of the standard deviation: 1.4826 times the median of |values|, for values about 0.
double robust_deviation(std::vector<double> values);

/// y = mean_y + slope (x - mean_x) by least squares.
struct StraightLine {
  double n = 0.0, slope = 0.0, mean_x = 0.0, mean_y = 0.0;
  double spread_x = 0.0;   ///< sum of (x - mean_x)^2; 0: no slope
  double deviation = 0.0;  ///< standard deviation of the readings about the line, for n > 2

  double at(double x) const { return mean_y + slope * (x - mean_x); }
  /// Half of the 95 % interval of the line at x, or of one more reading there (Student); for n > 2.
  double half_width(double x) const;
  double half_width_of_reading(double x) const;
  double half_width_of_slope() const;
};
StraightLine straight_line(const std::vector<double>& x, const std::vector<double>& y);

/// Correlation of successive values of a series about 0.
double successive_correlation(const std::vector<double>& values);

/// What correlated noise leaves of n readings.
struct CorrelatedNoise {
  double inflation = 1.0;    ///< of a parameter's variance, (1 + rho)/(1 - rho)
  double independent = 0.0;  ///< readings without correlation that carry as much, n over the inflation
};

/// By the correlation of the n residuals that a fit of so many parameters leaves, which reads low by
/// (1 + 3 rho + parameters)/n (Marriott and Pope 1954). A correlation that white noise has as well, below 1.65/sqrt(n)
/// (one record in twenty), counts as none; of few readings three degrees of freedom are left.
CorrelatedNoise correlated_noise(double correlation, double n, double parameters);

}  // namespace tremie
