// The emulator on a known function, and the posterior on Gaussians.

#include <gtest/gtest.h>

#include <cmath>

#include "apparatus/calibration/chains.hpp"
#include "apparatus/calibration/emulator.hpp"
#include "apparatus/calibration/posterior.hpp"
#include "apparatus/study/design.hpp"

namespace tremie::calibration {
namespace {

double known(const Point& x) { return 500.0 - 120.0 * x[0] + 40.0 * std::sin(3.0 * x[1]) * x[0]; }

// A smooth function of range 120 from 30 runs: an emulator that is off by 1 % of it has failed. Leaving one out
// must not say less than half of the error that is really made, nor ten times as much.
TEST(Emulator, FollowsASmoothFunctionAndKnowsItsError) {
  const auto points = study::unit_points(study::Method::latin_hypercube, 30, 2, 3);
  std::vector<double> values;
  for (const Point& p : points) values.push_back(known(p));
  const Emulator emulator = train(points, values, false);
  const auto elsewhere = study::unit_points(study::Method::sobol, 200, 2, 5);
  const auto predicted = predict(emulator, elsewhere);
  double error = 0.0, left_out = 0.0;
  for (std::size_t i = 0; i < elsewhere.size(); ++i)
    error += std::pow(predicted[i].mean - known(elsewhere[i]), 2) / 200.0;
  for (const double residual : emulator.left_out) left_out += residual * residual / 30.0;
  EXPECT_LT(std::sqrt(error), 1.2);
  EXPECT_GT(std::sqrt(left_out), 0.5 * std::sqrt(error));
  EXPECT_LT(std::sqrt(left_out), 10.0 * std::sqrt(error));
}

// Leaving one out in closed form is training on the others with the same covariance: checked by what it must
// be for a function that the process holds exactly, a constant plus noise of known size.
TEST(Emulator, LeftOutResidualsAreTheNoiseOfAFlatFunction) {
  const auto points = study::unit_points(study::Method::latin_hypercube, 60, 1, 4);
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); ++i) values.push_back(10.0 + (i % 2 ? 1.0 : -1.0));
  double sum = 0.0;
  for (const double r : train(points, values, false).left_out) sum += r * r / 60.0;
  EXPECT_NEAR(std::sqrt(sum), 1.0, 0.35);
}

// A Gaussian of deviation 0.05 about 0.4: quantiles 0.4 ± 1.96 x 0.05.
TEST(Posterior, QuantilesOfAGaussian) {
  auto points = quadrature_points(2);
  std::vector<double> log_likelihood;
  for (const Point& p : points) log_likelihood.push_back(-0.5 * std::pow((p[0] - 0.4) / 0.05, 2));
  const auto posterior = make_posterior(points, log_likelihood);
  EXPECT_NEAR(quantile(posterior, 0, 0.5), 0.4, 1e-3);
  EXPECT_NEAR(quantile(posterior, 0, 0.025), 0.302, 2e-3);
  EXPECT_NEAR(quantile(posterior, 0, 0.975), 0.498, 2e-3);
  EXPECT_NEAR(quantile(posterior, 1, 0.025), 0.025, 1e-3);  // nothing is said of the other unknown
  EXPECT_EQ(told(0.302, 0.498), "identified");
  EXPECT_EQ(told(0.025, 0.975), "not_told");
  EXPECT_EQ(told(0.4, 1.0), "bound");
}

// A Gaussian of three unknowns, two of them correlated by 0.9: deviations 0.05 about 0.5, to the tenth that 400 draws
// give. Chains apart from each other are told by R-hat; an autoregression of 0.9 leaves 1 in 19 draws.
TEST(Chains, DrawFromAGaussianAndKnowWhetherTheyConverged) {
  const auto log_likelihood = [](const Point& x) {
    const double a = (x[0] - 0.5) / 0.05, b = (x[1] - 0.5) / 0.05, c = (x[2] - 0.5) / 0.05;
    return -0.5 * ((a * a - 1.8 * a * b + b * b) / 0.19 + c * c);
  };
  auto points = quadrature_points(3);
  std::vector<double> logs;
  for (const Point& p : points) logs.push_back(log_likelihood(p));
  const Chains drawn = sample(make_posterior(points, logs), log_likelihood);
  EXPECT_LT(drawn.r_hat, 1.05);
  EXPECT_GT(drawn.effective, 400.0);
  const Posterior posterior = make_posterior(drawn.points, std::vector<double>(drawn.points.size(), 0.0));
  for (const std::size_t i : {0u, 1u, 2u}) {
    EXPECT_NEAR(quantile(posterior, i, 0.5), 0.5, 0.01);
    EXPECT_NEAR(quantile(posterior, i, 0.84) - quantile(posterior, i, 0.16), 2.0 * 0.05 * 0.994458, 0.01);
  }
  std::vector<std::vector<double>> apart(2), slow(1);
  for (int i = 0; i < 400; ++i)
    for (const std::size_t c : {0u, 1u}) apart[c].push_back(static_cast<double>(c) + 0.1 * std::sin(7.0 * i));
  EXPECT_GT(r_hat(apart), 2.0);
  double x = 0.0;
  const auto noise = study::unit_points(study::Method::latin_hypercube, 4000, 1, 9);
  for (const Point& p : noise) slow[0].push_back(x = 0.9 * x + (p[0] - 0.5));
  EXPECT_NEAR(effective_draws(slow), 4000.0 / 19.0, 100.0);
}

// The mixture of one Gaussian of mean 550 and deviation 4.
TEST(Posterior, ForecastOfOneGaussian) {
  const Posterior one{{{0.5}}, {1.0}, 0};
  EXPECT_NEAR(mixture_quantile(one, {{550.0, 16.0}}, 0.5), 550.0, 1e-6);
  EXPECT_NEAR(mixture_quantile(one, {{550.0, 16.0}}, 0.975), 550.0 + 1.959964 * 4.0, 1e-4);
}

}  // namespace
}  // namespace tremie::calibration
