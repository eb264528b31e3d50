// The rate_power kinetics' update: its special cases, closed forms, CVODE, order, steps of any length, modes.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/reference/flocculation_ode.hpp"

namespace tremie {
namespace {

constexpr double tau_0 = 54.0, A_thix = 1.3, k = 0.26;
constexpr double none = std::numeric_limits<double>::infinity();

Thixotropy rate_power(double a, double n = 1.0, double saturation = none, double gamma_c = 0.0,
                      std::vector<BreakdownMode> modes = {}) {
  return {A_thix, RatePowerKinetics{k, a, gamma_c, n, saturation, std::move(modes)}};
}

std::vector<double> by_cvode(const Thixotropy& t, double lambda, const ShearPiece& piece,
                             const std::vector<double>& times) {
  return flocculation_ode(std::span(&piece, 1), t, tau_0, lambda, times).lambda;
}

double by_cvode(const Thixotropy& t, double lambda, double rate, double duration) {
  return by_cvode(t, lambda, ShearPiece{duration, [rate](double) { return rate; }}, {duration})[0];
}

// a = 1: Roussel's, the gated and the power kinetics, digit for digit.
TEST(RatePowerKinetics, HasTheOthersAsSpecialCases) {
  for (const auto& rates : {std::pair{0.0, 3.0}, {3.0, 0.02}, {12.0, 11.0}, {0.05, 0.01}, {0.0, 0.0}})
    for (const double dt : {1e-3, 0.3, 50.0}) {
      const auto step = [&](const Kinetics& kinetics) {
        return flocculation_step(5.78, Thixotropy{A_thix, kinetics}, tau_0, rates.first, rates.second, dt);
      };
      EXPECT_EQ(step(RatePowerKinetics{k, 1.0}), step(RousselKinetics{k}));
      EXPECT_EQ(step(RatePowerKinetics{k, 1.0, 0.1}), step(GatedKinetics{k, 0.1}));
      EXPECT_EQ(step(RatePowerKinetics{k, 1.0, 0.0, 3.5, 40.0}), step(PowerKinetics{k, 0.0, 3.5, 40.0}));
      EXPECT_EQ(step(RatePowerKinetics{k, 1.0, 0.1, 3.5, 40.0}), step(PowerKinetics{k, 0.1, 3.5, 40.0}));
    }
}

// One step at constant rate, k gamma_dot^a dt from 1e-3 to 1e6.
TEST(RatePowerKinetics, OneStepIsCvodesWithin1e8) {
  for (const double a : {0.0, 0.03, 0.2, 0.5})
    for (const double n : {1.0, 3.5})
      for (const double saturation : {2.0, none})
        for (const double size : {1e-3, 1.0, 1e2, 1e6}) {
          const Thixotropy t = rate_power(a, n, saturation);
          const double rate = 0.04, dt = size / (k * std::pow(rate, a) * std::pow(5.78, n - 1.0));
          const double reference = by_cvode(t, 5.78, rate, dt);
          EXPECT_NEAR(flocculation_step(5.78, t, tau_0, rate, rate, dt), reference,
                      1e-8 * std::max(1.0, reference))
              << a << ' ' << n << ' ' << saturation << ' ' << size;
        }
}

// Without build-up lambda e^(-k int gamma_dot^a dt); from 0 to g in the time dt the integral is g^a dt/(1 + a).
TEST(RatePowerKinetics, DecayAtALinearRateIsExact) {
  for (const double a : {0.0, 0.03, 0.2, 0.7}) {
    Thixotropy t = rate_power(a);
    t.A_thix = 0.0;
    const double exact = 5.0 * std::exp(-k * std::pow(9.0, a) * 3.0 / (1.0 + a));
    EXPECT_NEAR(flocculation_step(5.0, t, tau_0, 0.0, 9.0, 3.0) / exact, 1.0, 1e-13) << a;
    EXPECT_NEAR(flocculation_step(5.0, t, tau_0, 9.0, 0.0, 3.0) / exact, 1.0, 1e-13) << a;
  }
}

// Rigid concrete builds up whatever a: gamma_dot^a is 0 at rest.
TEST(RatePowerKinetics, RestOnlyBuildsUp) {
  for (const double a : {0.0, 0.03, 1.0})
    EXPECT_NEAR(flocculation_step(2.0, rate_power(a), tau_0, 0.0, 0.0, 240.0), 2.0 + A_thix / tau_0 * 240.0,
                1e-12);
}

// Rate 1 + 5 (1 - cos t): halving the step divides the error by four.
TEST(RatePowerKinetics, IsOfSecondOrderOnACurvedHistory) {
  const auto rate = [](double time) { return 1.0 + 5.0 * (1.0 - std::cos(time)); };
  for (const double n : {1.0, 3.0}) {
    const Thixotropy t = rate_power(0.3, n);
    const double reference = by_cvode(t, 5.78, ShearPiece{10.0, rate}, {10.0})[0];
    const auto error = [&](int steps) {
      const double dt = 10.0 / steps;
      double lambda = 5.78;
      for (int i = 0; i < steps; ++i)
        lambda = flocculation_step(lambda, t, tau_0, rate(i * dt), rate((i + 1) * dt), dt);
      return std::abs(lambda - reference);
    };
    EXPECT_NEAR(std::log2(error(50) / error(100)), 2.0, 0.2) << n;
  }
}

// Positive and bounded, whatever step, rate and exponents; k of 0 and 1e6, lambda_max below lambda.
TEST(RatePowerKinetics, IsPositiveAndBoundedForEveryStep) {
  for (const double strength : {0.0, 1e-6, 1e6})
    for (const double a : {0.0, 0.03, 0.5})
      for (const double gamma_c : {0.0, 1e-6, 100.0})
        for (const double start : {0.0, 5.78, 1e4})
          for (double dt = 1e-6; dt < 1e9; dt *= 100.0)
            for (const auto& [g_0, g_1] : {std::pair{0.0, 12.0}, {50.0, 0.0}, {1e-300, 1e4}, {0.0, 0.0}}) {
              const Thixotropy t{A_thix, RatePowerKinetics{strength, a, gamma_c, 1.0, 3.0}};
              const double next = flocculation_step(start, t, tau_0, g_0, g_1, dt);
              ASSERT_TRUE(std::isfinite(next));
              ASSERT_GE(next, 0.0);
              ASSERT_LE(next, start + A_thix / tau_0 * dt * (1 + 1e-12));
            }
}

double step_in_parts(const Thixotropy& t, double lambda, double rate, double dt) {
  std::vector<double> parts;
  for (const double share : part_shares(t.kinetics)) parts.push_back(share * lambda);
  return flocculation_step(lambda, t, tau_0, rate, rate, dt,
                           [&](std::size_t i) -> double& { return parts[i]; });
}

// Six equal modes are one; three modes, and rates from 1e-9 to 1e9 of k, are CVODE's.
TEST(RatePowerKinetics, ModesAreASumOfTimes) {
  const std::vector<BreakdownMode> six(6, {1.0 / 6.0, 1.0});
  const double one = flocculation_step(5.78, rate_power(0.2, 2.0), tau_0, 3.0, 3.0, 0.7);
  EXPECT_NEAR(step_in_parts(rate_power(0.2, 2.0, none, 0.0, six), 5.78, 3.0, 0.7) / one, 1.0, 1e-13);
  for (const std::vector<BreakdownMode>& modes :
       {std::vector<BreakdownMode>{{0.6, 1.0}, {0.3, 0.1}, {0.1, 0.01}},
        std::vector<BreakdownMode>{{0.5, 1e-9}, {0.5, 1e9}},
        std::vector<BreakdownMode>{{0.9, 1.0}, {0.1, 1e6}}})
    for (const double dt : {0.01, 1.0, 100.0}) {
      const Thixotropy t = rate_power(0.2, 1.0, none, 0.0, modes);
      EXPECT_NEAR(step_in_parts(t, 5.78, 3.0, dt) / by_cvode(t, 5.78, 3.0, dt), 1.0, 1e-9) << dt;
    }
}

}  // namespace
}  // namespace tremie
