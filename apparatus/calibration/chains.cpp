#include "apparatus/calibration/chains.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <openturns/CovarianceMatrix.hxx>
#include <openturns/EvaluationImplementation.hxx>
#include <openturns/Function.hxx>
#include <openturns/Interval.hxx>
#include <openturns/Normal.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/RandomWalkMetropolisHastings.hxx>

namespace tremie::calibration {
namespace {

constexpr std::size_t chains = 4, draws = 1000, burn_in = 500, thinning = 4;

class LogLikelihood : public OT::EvaluationImplementation {
 public:
  LogLikelihood(std::size_t unknowns, const std::function<double(const Point&)>& of)
      : unknowns_(unknowns), of_(of) {}
  LogLikelihood* clone() const override { return new LogLikelihood(*this); }
  OT::UnsignedInteger getInputDimension() const override { return unknowns_; }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }
  using OT::EvaluationImplementation::operator();
  OT::Point operator()(const OT::Point& x) const override {
    return OT::Point(1, of_(Point(x.begin(), x.end())));
  }

 private:
  std::size_t unknowns_;
  std::function<double(const Point&)> of_;
};

double mean(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

/// Of v about its mean, `lag` apart; lag 0 is the variance.
double autocovariance(const std::vector<double>& v, std::size_t lag) {
  const double m = mean(v);
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < v.size(); ++i) sum += (v[i] - m) * (v[i + lag] - m);
  return sum / static_cast<double>(v.size());
}

/// Steps of 2.38/sqrt(n) standard deviations are the best for a Gaussian (Gelman, Roberts and Gilks, 1996).
OT::CovarianceMatrix steps_of(const Posterior& first) {
  const std::size_t n = first.points.front().size();
  Point mean_point(n, 0.0);
  for (std::size_t k = 0; k < first.points.size(); ++k)
    for (std::size_t i = 0; i < n; ++i) mean_point[i] += first.weights[k] * first.points[k][i];
  OT::CovarianceMatrix steps(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = i == j ? 1e-6 : 0.0;
      for (std::size_t k = 0; k < first.points.size(); ++k)
        sum += first.weights[k] * (first.points[k][i] - mean_point[i]) * (first.points[k][j] - mean_point[j]);
      steps(i, j) = 5.66 / static_cast<double>(n) * sum;
    }
  return steps;
}

/// Where a chain starts: quantiles of the first posterior in the order of its points, far from each other.
Point start_of(const Posterior& first, std::size_t chain) {
  double sum = 0.0;
  for (std::size_t k = 0; k < first.points.size(); ++k)
    if ((sum += first.weights[k]) > (static_cast<double>(chain) + 0.5) / static_cast<double>(chains))
      return first.points[k];
  return first.points[first.best];
}

}  // namespace

double r_hat(const std::vector<std::vector<double>>& of) {
  std::vector<double> means, variances;
  const std::size_t half = of.front().size() / 2;
  for (const auto& chain : of)
    for (const std::size_t from : {std::size_t{0}, chain.size() - half}) {
      const auto begin = chain.begin() + static_cast<std::ptrdiff_t>(from);
      const std::vector<double> part(begin, begin + static_cast<std::ptrdiff_t>(half));
      means.push_back(mean(part));
      variances.push_back(autocovariance(part, 0) * static_cast<double>(half) /
                          static_cast<double>(half - 1));
    }
  const auto m = static_cast<double>(means.size()), n = static_cast<double>(half);
  const double within = mean(variances), between = autocovariance(means, 0) * m / (m - 1.0);
  return std::sqrt((n - 1.0) / n + between / within);
}

double effective_draws(const std::vector<std::vector<double>>& of) {
  const std::size_t n = of.front().size();
  const auto correlation = [&](std::size_t lag) {
    double sum = 0.0, variance = 0.0;
    for (const auto& chain : of) sum += autocovariance(chain, lag), variance += autocovariance(chain, 0);
    return sum / variance;
  };
  double sum = 0.0;
  for (std::size_t lag = 1; lag + 1 < n; lag += 2) {
    const double pair = correlation(lag) + correlation(lag + 1);
    if (pair < 0.0) break;
    sum += pair;
  }
  return static_cast<double>(n * of.size()) / (1.0 + 2.0 * sum);
}

Chains sample(const Posterior& first, const std::function<double(const Point&)>& log_likelihood) {
  const std::size_t n = first.points.front().size();
  const OT::Function target(LogLikelihood(n, log_likelihood));
  const OT::Normal steps(OT::Point(n, 0.0), steps_of(first));
  OT::RandomGenerator::SetSeed(1);
  std::vector<std::vector<std::vector<double>>> by_unknown(n);
  Chains result;
  for (std::size_t c = 0; c < chains; ++c) {
    const Point start = start_of(first, c);
    OT::RandomWalkMetropolisHastings walk(target, OT::Interval(n), OT::Point(start.begin(), start.end()),
                                          steps);
    walk.setBurnIn(burn_in);
    walk.setThinning(thinning);
    const OT::Sample drawn = walk.getSample(draws);
    for (std::size_t i = 0; i < n; ++i) {
      by_unknown[i].emplace_back();
      for (std::size_t k = 0; k < draws; ++k) by_unknown[i].back().push_back(drawn(k, i));
    }
    for (std::size_t k = 0; k < draws; ++k) {
      const OT::Point p = drawn[k];
      result.points.emplace_back(p.begin(), p.end());
    }
  }
  result.effective = INFINITY;
  for (const auto& unknown : by_unknown) {
    result.r_hat = std::max(result.r_hat, r_hat(unknown));
    result.effective = std::min(result.effective, effective_draws(unknown));
  }
  return result;
}

}  // namespace tremie::calibration
