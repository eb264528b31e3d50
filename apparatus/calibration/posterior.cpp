#include "apparatus/calibration/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apparatus/study/design.hpp"

namespace tremie::calibration {
namespace {

constexpr std::size_t line = 401, side = 71, sobol_points = 16384;

}  // namespace

std::vector<Point> quadrature_points(std::size_t unknowns) {
  if (unknowns > 2) return study::unit_points(study::Method::sobol, sobol_points, unknowns, 1);
  std::vector<Point> points;
  const std::size_t n = unknowns == 1 ? line : side;
  const auto at = [n](std::size_t i) { return (static_cast<double>(i) + 0.5) / static_cast<double>(n); };
  for (std::size_t i = 0; i < n; ++i) {
    if (unknowns == 1) points.push_back({at(i)});
    for (std::size_t j = 0; j < n && unknowns == 2; ++j) points.push_back({at(i), at(j)});
  }
  return points;
}

Posterior make_posterior(std::vector<Point> points, const std::vector<double>& log_likelihood) {
  Posterior posterior{std::move(points), {}, 0};
  const auto top = std::max_element(log_likelihood.begin(), log_likelihood.end());
  posterior.best = static_cast<std::size_t>(top - log_likelihood.begin());
  for (const double l : log_likelihood) posterior.weights.push_back(std::exp(l - *top));
  const double sum = std::accumulate(posterior.weights.begin(), posterior.weights.end(), 0.0);
  for (double& w : posterior.weights) w /= sum;
  return posterior;
}

/// The weight of each distinct coordinate is spread evenly over the gap around it.
double quantile(const Posterior& posterior, std::size_t unknown, double q) {
  std::vector<std::pair<double, double>> marginal;
  for (std::size_t i = 0; i < posterior.points.size(); ++i)
    marginal.emplace_back(posterior.points[i][unknown], posterior.weights[i]);
  std::sort(marginal.begin(), marginal.end());
  std::vector<std::pair<double, double>> merged;
  for (const auto& [x, w] : marginal) {
    if (!merged.empty() && x - merged.back().first < 1e-9)
      merged.back().second += w;
    else
      merged.emplace_back(x, w);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < merged.size(); ++i) {
    const auto [x, w] = merged[i];
    const double left = i == 0 ? 0.0 : 0.5 * (merged[i - 1].first + x);
    const double right = i + 1 == merged.size() ? 1.0 : 0.5 * (x + merged[i + 1].first);
    if (sum + w >= q) return left + (right - left) * (w > 0.0 ? (q - sum) / w : 0.0);
    sum += w;
  }
  return 1.0;
}

double effective_points(const Posterior& posterior) {
  double squares = 0.0;
  for (const double w : posterior.weights) squares += w * w;
  return 1.0 / squares;
}

double mixture_quantile(const Posterior& posterior, const std::vector<Prediction>& predictions, double q) {
  double low = INFINITY, high = -INFINITY;
  for (const Prediction& p : predictions) {
    const double width = 6.0 * std::sqrt(p.variance);
    low = std::min(low, p.mean - width);
    high = std::max(high, p.mean + width);
  }
  const auto below = [&](double value) {
    double sum = 0.0;
    for (std::size_t i = 0; i < predictions.size(); ++i) {
      if (posterior.weights[i] < 1e-9) continue;
      const double deviation = std::sqrt(std::max(predictions[i].variance, 1e-18));
      sum += posterior.weights[i] * 0.5 *
             std::erfc((predictions[i].mean - value) / (deviation * std::sqrt(2.0)));
    }
    return sum;
  };
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (below(middle) < q ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double log_likelihood(double value, double error, const Prediction& run, double cells) {
  const double variance = error * error + run.variance + cells * cells, off = value - run.mean;
  return -0.5 * (off * off / variance + std::log(variance));
}

std::string told(double low, double high) {
  constexpr double edge = 0.03;
  const double width = high - low;
  if (width > 0.8) return "not_told";
  return width < 0.5 && low > edge && high < 1.0 - edge ? "identified" : "bound";
}

}  // namespace tremie::calibration
