// The power kinetics' update: closed forms, CVODE, order, and steps of any length.

#include <gtest/gtest.h>

#include <cmath>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/reference/flocculation_ode.hpp"

namespace tremie {
namespace {

constexpr double tau_0 = 54.0;

constexpr double alpha = 0.0358;

Thixotropy power(double exponent, double saturation, double gamma_c = 0.0) {
  return {1.3, PowerKinetics{alpha, gamma_c, exponent, saturation}};
}

double by_cvode(const Thixotropy& t, double lambda, double rate, double duration) {
  const ShearPiece piece{duration, [rate](double) { return rate; }};
  const double end[] = {duration};
  return flocculation_ode(std::span(&piece, 1), t, tau_0, lambda, end).lambda[0];
}

// One step at constant rate, alpha lambda^(n-1) gamma_dot dt from 1e-3 to 1e6, from above and from below.
TEST(PowerKinetics, OneStepIsCvodesWithin1e8) {
  for (const double exponent : {1.0, 1.7, 3.5, 6.0})
    for (const double start : {0.0, 0.01, 5.78, 38.0})
      for (const double k : {1e-3, 1.0, 1e2, 1e4, 1e6}) {
        const Thixotropy t = power(exponent, 40.0);
        const double rate = 12.43, dt = k / (alpha * rate * std::pow(std::max(start, 1.0), exponent - 1.0));
        const double reference = by_cvode(t, start, rate, dt);
        EXPECT_NEAR(flocculation_step(start, t, tau_0, rate, rate, dt), reference,
                    1e-8 * std::max(1.0, reference))
            << exponent << ' ' << start << ' ' << k;
      }
}

// n = 1 without a saturation is Roussel's equation, whose update is exact at constant rate.
TEST(PowerKinetics, IsRousselsAtExponentOne) {
  const Thixotropy t = power(1.0, std::numeric_limits<double>::infinity());
  const Thixotropy roussel{1.3, RousselKinetics{alpha}};
  for (const double dt : {1e-3, 1.0, 100.0})
    EXPECT_NEAR(flocculation_step(5.78, t, tau_0, 3.0, 3.0, dt) /
                    flocculation_step(5.78, roussel, tau_0, 3.0, 3.0, dt),
                1.0, 1e-12);
}

// At rest lambda_max - (lambda_max - lambda) exp(-b t/lambda_max).
TEST(PowerKinetics, RestSaturates) {
  const Thixotropy t = power(3.5, 40.0);
  const double exact = 40.0 - (40.0 - 2.0) * std::exp(-1.3 / tau_0 * 600.0 / 40.0);
  EXPECT_NEAR(flocculation_after_rest(2.0, t, tau_0, 600.0) / exact, 1.0, 1e-13);
  EXPECT_NEAR(flocculation_step(2.0, t, tau_0, 0.0, 0.0, 600.0) / exact, 1.0, 1e-10);
}

// dlambda/dt = -alpha lambda^n gamma_dot above the gate: lambda (1 + (n-1) k)^(-1/(n-1)), exact for a linear rate.
TEST(PowerKinetics, GatedIsExactAtALinearRate) {
  const Thixotropy t = power(3.5, 40.0, 0.1);
  const double k = alpha * std::pow(5.0, 2.5) * 0.5 * (1.0 + 9.0) * 3.0;
  EXPECT_NEAR(flocculation_step(5.0, t, tau_0, 1.0, 9.0, 3.0) / (5.0 * std::pow(1.0 + 2.5 * k, -0.4)), 1.0,
              1e-13);
}

// Rate 5 (1 - cos t): halving the step divides the error by four, until it is that of the parts of a step.
TEST(PowerKinetics, IsOfSecondOrderOnACurvedHistory) {
  const Thixotropy t = power(3.5, 40.0);
  const auto rate = [](double time) { return 5.0 * (1.0 - std::cos(time)); };
  const ShearPiece piece{10.0, rate};
  const double end[] = {10.0};
  const double reference = flocculation_ode(std::span(&piece, 1), t, tau_0, 5.78, end).lambda[0];
  const auto error = [&](int steps) {
    const double dt = 10.0 / steps;
    double lambda = 5.78;
    for (int i = 0; i < steps; ++i)
      lambda = flocculation_step(lambda, t, tau_0, rate(i * dt), rate((i + 1) * dt), dt);
    return std::abs(lambda - reference);
  };
  EXPECT_NEAR(std::log2(error(50) / error(100)), 2.0, 0.2);
  EXPECT_LT(error(20000), 1e-8);
}

// Positive and bounded: from above never below 0 or above the start plus what is built, whatever the step.
TEST(PowerKinetics, IsPositiveAndBoundedForEveryStep) {
  for (const double exponent : {1.0, 1.2, 3.5, 10.0})
    for (const double gate : {0.0, 0.1})
      for (const double start : {0.0, 1e-6, 5.78, 1e4})
        for (double dt = 1e-6; dt < 1e9; dt *= 10.0)
          for (const auto& [g0, g1] : {std::pair{0.0, 12.0}, {50.0, 0.0}, {1e4, 1e4}, {0.0, 0.0}}) {
            const Thixotropy t = power(exponent, 2e4, gate);
            const double next = flocculation_step(start, t, tau_0, g0, g1, dt);
            ASSERT_TRUE(std::isfinite(next));
            ASSERT_GE(next, 0.0) << exponent << ' ' << start << ' ' << dt;
            ASSERT_LE(next, start + t.A_thix / tau_0 * dt * (1 + 1e-12))
                << exponent << ' ' << start << ' ' << dt;
          }
}

TEST(PowerKinetics, PointsSideBySideAreTheSame) {
  const Thixotropy t = power(3.5, 40.0);
  f64x8 lambda{}, g0{}, g1{};
  for (int l = 0; l < 8; ++l) {
    lambda[l] = 0.7 * l;
    g0[l] = 1.0 + l;
    g1[l] = 8.0 - l;
  }
  const f64x8 next = flocculation_step(lambda, t, tau_0, g0, g1, 0.37);
  for (int l = 0; l < 8; ++l) EXPECT_EQ(next[l], flocculation_step(lambda[l], t, tau_0, g0[l], g1[l], 0.37));
}

}  // namespace
}  // namespace tremie
