#include "apparatus/calibration/emulator.hpp"

#include <cmath>
#include <limits>
#include <openturns/ConstantBasisFactory.hxx>
#include <openturns/KrigingAlgorithm.hxx>
#include <openturns/Log.hxx>
#include <openturns/MaternModel.hxx>
#include <openturns/SquareMatrix.hxx>
#include <stdexcept>

namespace tremie::calibration {
namespace {

/// Runs scatter about a smooth reading: the variance of that scatter over the reading's, one of these.
constexpr double nuggets[] = {1e-6, 1e-4, 1e-3, 1e-2};
constexpr double shortest = 0.05, longest = 10.0;  ///< correlation lengths, over the range

OT::Sample sample_of(const std::vector<Point>& points) {
  OT::Sample sample(points.size(), points.front().size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < points[i].size(); ++j) sample(i, j) = points[i][j];
  return sample;
}

/// Dubrule's formula: the residuals of leaving one out from the inverse of [[K, 1], [1', 0]], without training
/// again.
std::vector<double> leave_one_out(const OT::CovarianceModel& model, const OT::Sample& x,
                                  const OT::Sample& y) {
  const auto n = x.getSize();
  const OT::CovarianceMatrix k = model.discretize(x);
  OT::SquareMatrix bordered(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) bordered(i, j) = k(i, j);
    bordered(i, n) = bordered(n, i) = 1.0;
  }
  OT::Matrix identity(n + 1, n + 1);
  for (std::size_t i = 0; i <= n; ++i) identity(i, i) = 1.0;
  const OT::Matrix inverse = bordered.solveLinearSystem(identity);
  std::vector<double> residuals(n);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) sum += inverse(i, j) * y(j, 0);
    residuals[i] = -sum / inverse(i, i);
  }
  return residuals;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return sum / static_cast<double>(values.size());
}

struct Fitted {
  OT::KrigingResult result;
  std::vector<double> residuals;
};

Fitted fit(const OT::Sample& x, const OT::Sample& y, double nugget) {
  const auto n = x.getDimension();
  OT::MaternModel model(OT::Point(n, 0.5), OT::Point(1, 1.0), 2.5);
  model.setNuggetFactor(nugget);
  OT::KrigingAlgorithm algorithm(x, y, model, OT::ConstantBasisFactory(n).build());
  algorithm.setOptimizationBounds(OT::Interval(OT::Point(n, shortest), OT::Point(n, longest)));
  algorithm.run();
  const auto result = algorithm.getResult();
  return {result, leave_one_out(result.getCovarianceModel(), x, y)};
}

}  // namespace

struct Emulator::State {
  OT::KrigingResult result;
  double mean, scale;
  bool logarithmic;
};

Emulator train(const std::vector<Point>& points, const std::vector<double>& values, bool logarithmic) {
  if (points.size() < points.front().size() + 3)
    throw std::invalid_argument("too few runs with a number for an emulator");
  OT::Log::Show(OT::Log::NONE);
  const OT::Sample x = sample_of(points);
  OT::Sample y(values.size(), 1);
  for (std::size_t i = 0; i < values.size(); ++i) y(i, 0) = logarithmic ? std::log(values[i]) : values[i];
  const double mean = y.computeMean()[0];
  const double scale = std::max(y.computeStandardDeviation()[0], 1e-12);
  for (std::size_t i = 0; i < values.size(); ++i) y(i, 0) = (y(i, 0) - mean) / scale;
  Fitted best{{}, {}};
  double least = std::numeric_limits<double>::infinity();
  for (const double nugget : nuggets) {
    Fitted fitted = fit(x, y, nugget);
    if (const double error = mean_square(fitted.residuals); error < least) {
      least = error;
      best = std::move(fitted);
    }
  }
  Emulator emulator;
  emulator.state = std::make_shared<Emulator::State>(Emulator::State{best.result, mean, scale, logarithmic});
  for (std::size_t i = 0; i < values.size(); ++i)
    emulator.left_out.push_back(logarithmic ? values[i] * std::expm1(scale * best.residuals[i])
                                            : scale * best.residuals[i]);
  return emulator;
}

std::vector<Prediction> predict(const Emulator& emulator, const std::vector<Point>& points) {
  const auto& s = *emulator.state;
  const OT::Sample x = sample_of(points);
  const OT::Sample mean = s.result.getConditionalMean(x);
  std::vector<Prediction> predictions(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double variance = s.scale * s.scale * std::max(0.0, s.result.getConditionalMarginalVariance(x[i]));
    const double value = s.mean + s.scale * mean(i, 0);
    predictions[i] = s.logarithmic ? Prediction{std::exp(value), std::exp(2.0 * value) * variance}
                                   : Prediction{value, variance};
  }
  return predictions;
}

}  // namespace tremie::calibration
