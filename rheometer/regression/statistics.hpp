#pragma once

// The few statistics that a fit's confidence intervals and outlier tests need.

#include <vector>

namespace tremie {

/// P(T <= t) of Student's distribution with `degrees` > 0 degrees of freedom.
double student_probability(double t, double degrees);

/// P(F > f) of Fisher's distribution with d1 and d2 > 0 degrees of freedom.
double fisher_tail(double f, double d1, double d2);

/// The t with P(T <= t) = probability, 0 < probability < 1.
double student_quantile(double probability, double degrees);

/// Median; 0 for an empty vector.
double median(std::vector<double> values);

/// Robust estimate of the standard deviation: 1.4826 times the median of |values|, for values about 0.
double robust_deviation(std::vector<double> values);

/// Correlation of successive values of a series about 0.
double successive_correlation(const std::vector<double>& values);

}  // namespace tremie
