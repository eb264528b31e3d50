// Verification case 2: lambda of one point against closed forms and an integration of equation (3) that is the test's own.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "libmpm/constitutive/mix.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {
namespace {

constexpr double tau_0 = 54.0;
constexpr double alpha = 0.0358;
const Thixotropy roussel{1.3, RousselKinetics{alpha}};
const Thixotropy gated{1.3, GatedKinetics{alpha, 0.1}};

using History = std::function<double(double)>;

double march(const Thixotropy& t, const History& rate, double lambda, double end, int steps) {
  const double dt = end / steps;
  for (int i = 0; i < steps; ++i)
    lambda = flocculation_step(lambda, t, tau_0, rate(i * dt), rate((i + 1) * dt), dt);
  return lambda;
}

/// d lambda/dt = A/tau_0 - alpha lambda gamma_dot by the classical Runge-Kutta method of fourth order.
double runge_kutta(const History& rate, double lambda, double end, int steps) {
  const double h = end / steps;
  const auto f = [&](double t, double y) { return roussel.A_thix / tau_0 - alpha * y * rate(t); };
  for (int i = 0; i < steps; ++i) {
    const double t = i * h, a = f(t, lambda), b = f(t + h / 2, lambda + h / 2 * a),
                 c = f(t + h / 2, lambda + h / 2 * b);
    lambda += h / 6 * (a + 2 * b + 2 * c + f(t + h, lambda + h * c));
  }
  return lambda;
}

// At rest lambda grows by A_thix t / tau_0: 5.78 for Mix A after 240 s (published, three digits).
TEST(Flocculation, Rest) {
  EXPECT_NEAR(flocculation_after_rest(0.0, roussel, tau_0, 240.0), 5.78, 5e-3);
  for (const Thixotropy& t : {roussel, gated})
    EXPECT_NEAR(march(
                    t, [](double) { return 0.0; }, 0.5, 240.0, 37),
                0.5 + 1.3 * 240.0 / 54.0, 1e-12);
}

// lambda = L + (lambda_0 - L) exp(-alpha g t), L = A/(tau_0 alpha g): exact whatever the step.
TEST(Flocculation, ConstantRate) {
  for (double rate : {1e-9, 1e-4, 0.3, 12.43, 1e3})
    for (int steps : {1, 3, 100}) {
      const double k = alpha * rate, L = roussel.A_thix / tau_0 / k, t = 20.0;
      const double exact = 5.78 * std::exp(-k * t) - L * std::expm1(-k * t);
      EXPECT_NEAR(march(
                      roussel, [&](double) { return rate; }, 5.78, t, steps) /
                      exact,
                  1.0, 1e-12);
    }
}

TEST(Flocculation, GatedConstantRate) {
  for (int steps : {1, 7}) {
    EXPECT_NEAR(march(
                    gated, [](double) { return 5.0; }, 5.78, 10.0, steps),
                5.78 * std::exp(-1.79), 1e-12);
    EXPECT_NEAR(march(
                    gated, [](double) { return 0.05; }, 1.0, 10.0, steps),
                1.0 + 13.0 / 54.0, 1e-12);
  }
}

// Halving the step divides the error by four on a smooth history: order 2, observed 1.9 at least.
TEST(Flocculation, SecondOrderOnSmoothHistories) {
  const History rate = [](double t) { return 8.0 * std::exp(-0.3 * t) * (1.5 + std::sin(2.0 * t)); };
  const double truth = runge_kutta(rate, 5.78, 10.0, 20000);
  double last = 0.0;
  for (int steps : {20, 40, 80, 160}) {
    const double error = std::abs(march(roussel, rate, 5.78, 10.0, steps) - truth);
    if (last > 0.0) {
      EXPECT_GE(std::log2(last / error), 1.9);
    }
    last = error;
  }
  EXPECT_LT(last, 1e-3 * truth);
}

// alpha gamma_dot dt = 1e6: lambda lands on the balance A/(tau_0 alpha g) and stays in [0, start + build-up].
TEST(Flocculation, HugeSteps) {
  const double rate = 1e4, dt = 1e6 / (alpha * rate);
  EXPECT_NEAR(flocculation_step(5.78, roussel, tau_0, rate, rate, dt) / (1.3 / 54.0 / (alpha * rate)), 1.0,
              1e-12);
  for (const Thixotropy& t : {roussel, gated})
    for (double k = 1e-12; k < 2e6; k *= 10.0)
      for (double g0 : {0.0, 0.05, 50.0})
        for (double g1 : {0.0, 0.05, 50.0}) {
          const double step = k / (alpha * 50.0), lambda = flocculation_step(2.0, t, tau_0, g0, g1, step);
          EXPECT_GE(lambda, 0.0);
          EXPECT_LE(lambda, (2.0 + t.A_thix / tau_0 * step) * (1.0 + 1e-12));
        }
}

// A linear ramp through the gate: build-up until gamma_c, then lambda exp(-alpha int gamma dt), exact in one
// step too.
TEST(Flocculation, GateCrossedOnARamp) {
  const History up = [](double t) { return 0.02 * t; };          // crosses 0.1 1/s at 5 s
  const History down = [](double t) { return 0.4 - 0.02 * t; };  // crosses it at 15 s
  const double build = 1.3 / 54.0;
  const double exact_up = (1.0 + build * 5.0) * std::exp(-0.0358 * (0.01 * 400.0 - 0.01 * 25.0));
  const double exact_down = std::exp(-0.0358 * (0.4 * 15.0 - 0.01 * 225.0)) + build * 5.0;
  for (int steps : {1, 3, 4, 1000}) {
    EXPECT_NEAR(march(gated, up, 1.0, 20.0, steps), exact_up, 1e-11) << steps;
    EXPECT_NEAR(march(gated, down, 1.0, 20.0, steps), exact_down, 1e-11) << steps;
  }
}

// A point stores position, velocity, affine velocity, mass, volume and ln J, eleven numbers in a section; with thixotropy
// lambda and the shear rate; with four modes their four parts too.
TEST(Flocculation, APointStoresWhatItsKineticsHas) {
  Mix mix;
  EXPECT_EQ(bytes_per_point<2>(lambda_numbers(mix)), 11 * 8);
  mix.thixotropy = Thixotropy{1.3, RatePowerKinetics{0.3, 0.1}};
  EXPECT_EQ(bytes_per_point<2>(lambda_numbers(mix)), 13 * 8);
  mix.thixotropy = Thixotropy{
      1.3, RatePowerKinetics{
               .breakdown = 0.3, .rate_exponent = 0.1, .modes = std::vector<BreakdownMode>(4, {0.25, 1.0})}};
  EXPECT_EQ(bytes_per_point<2>(lambda_numbers(mix)), 17 * 8);
}

}  // namespace
}  // namespace tremie
