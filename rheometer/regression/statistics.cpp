#include "rheometer/regression/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace tremie {

namespace {

/// Continued fraction of the incomplete beta function by Lentz's method (Numerical Recipes, section 6.4).
double beta_fraction(double a, double b, double x) {
  const double tiny = 1e-300;
  const auto away_from_zero = [&](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1.0, d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)), h = d;
  for (int m = 1; m <= 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    d = 1.0 / away_from_zero(1.0 + even * d);
    c = away_from_zero(1.0 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    d = 1.0 / away_from_zero(1.0 + odd * d);
    c = away_from_zero(1.0 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return h;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1.0) / (a + b + 2.0) ? front * beta_fraction(a, b, x) / a
                                       : 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

}  // namespace

double student_probability(double t, double degrees) {
  const double tail = 0.5 * incomplete_beta(0.5 * degrees, 0.5, degrees / (degrees + t * t));
  return t > 0.0 ? 1.0 - tail : tail;
}

double fisher_tail(double f, double d1, double d2) {
  return f > 0.0 ? incomplete_beta(0.5 * d2, 0.5 * d1, d2 / (d2 + d1 * f)) : 1.0;
}

double student_quantile(double probability, double degrees) {
  if (probability == 0.5) return 0.0;
  if (probability > 0.5) return -student_quantile(1.0 - probability, degrees);
  double low = -1.0, high = 0.0;  // the lower tail keeps its precision, so solve there
  while (student_probability(low, degrees) > probability && low > -1e15) low *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-14 * -low; ++i) {
    const double middle = 0.5 * (low + high);
    (student_probability(middle, degrees) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
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

}  // namespace tremie
