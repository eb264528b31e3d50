#include "rheometer/regression/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace tremie {

double fisher_tail(double f, double d1, double d2) {
  return f > 0.0 ? cdf(complement(boost::math::fisher_f(d1, d2), f)) : 1.0;
}

double student_quantile(double probability, double degrees) {
  return quantile(boost::math::students_t(degrees), probability);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double robust_deviation(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  return 1.4826 * median(std::move(values));
}

StraightLine straight_line(const std::vector<double>& x, const std::vector<double>& y) {
  StraightLine line;
  line.n = static_cast<double>(x.size());
  double product = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) line.mean_x += x[i] / line.n, line.mean_y += y[i] / line.n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    line.spread_x += (x[i] - line.mean_x) * (x[i] - line.mean_x);
    product += (x[i] - line.mean_x) * (y[i] - line.mean_y);
  }
  line.slope = line.spread_x > 0.0 ? product / line.spread_x : 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) squares += (y[i] - line.at(x[i])) * (y[i] - line.at(x[i]));
  line.deviation = line.n > 2.0 ? std::sqrt(squares / (line.n - 2.0)) : 0.0;
  return line;
}

double StraightLine::half_width_of_slope() const {
  return student_quantile(0.975, n - 2.0) * deviation / std::sqrt(spread_x);
}
double StraightLine::half_width(double x) const {
  return student_quantile(0.975, n - 2.0) * deviation *
         std::sqrt(1.0 / n + (x - mean_x) * (x - mean_x) / spread_x);
}
double StraightLine::half_width_of_reading(double x) const {
  return student_quantile(0.975, n - 2.0) * deviation *
         std::sqrt(1.0 + 1.0 / n + (x - mean_x) * (x - mean_x) / spread_x);
}

double successive_correlation(const std::vector<double>& values) {
  double product = 0.0, square = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    square += values[i] * values[i];
    if (i) product += values[i] * values[i - 1];
  }
  return square > 0.0 ? product / square : 0.0;
}

CorrelatedNoise correlated_noise(double correlation, double n, double parameters) {
  const double bias = (1.0 + 3.0 * correlation + parameters) / n;
  if (!(correlation + (1.0 + parameters) / n > 1.65 / std::sqrt(n))) return {1.0, n};
  const double rho = std::clamp(correlation + bias, 0.0, 0.98);
  const double most = std::max(1.0, n / (parameters + 3.0));
  const double inflation = std::min((1.0 + rho) / (1.0 - rho), most);
  return {inflation, n / inflation};
}

}  // namespace tremie
