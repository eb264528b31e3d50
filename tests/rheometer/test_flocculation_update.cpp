// The per-point updates of lambda (libmpm/constitutive/flocculation.hpp) against closed forms
// and against CVODE.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/reference/flocculation_ode.hpp"

namespace tremie {
namespace {

constexpr double tau_0 = 54.0;
constexpr double alpha = 0.0358;
const Thixotropy roussel{1.3, RousselKinetics{alpha}};
const Thixotropy gated{1.3, GatedKinetics{alpha, 0.1}};

double closed_form(double lambda_0, const Thixotropy& t, double gamma_dot, double time) {
  const long double k = static_cast<long double>(alpha) * gamma_dot * time;
  const long double build = k > 0.0L ? -std::expm1(-k) / k : 1.0L;
  return static_cast<double>(lambda_0 * std::exp(-k) + t.A_thix / tau_0 * time * build);
}

// One step of any length at a constant rate is exact up to rounding; the closed form is taken in long double.
TEST(FlocculationUpdate, IsExactAtConstantRateForAnyStep) {
  for (const double gamma_dot : {0.0, 1e-9, 0.05, 1.0, 12.43, 1e4})
    for (const double dt : {1e-9, 1e-4, 0.1, 1.0, 100.0, 1e4}) {
      const double exact = closed_form(5.78, roussel, gamma_dot, dt);
      EXPECT_NEAR(flocculation_step(5.78, roussel, tau_0, gamma_dot, gamma_dot, dt) / exact, 1.0, 1e-13)
          << gamma_dot << " 1/s, " << dt << " s";
      const auto rate = [&](double) { return gamma_dot; };
      EXPECT_NEAR(flocculation_step_along(5.78, roussel, tau_0, rate, 3.0, gamma_dot, gamma_dot, dt) / exact,
                  1.0, 1e-13)
          << gamma_dot << " 1/s, " << dt << " s";
    }
}

// alpha gamma_dot dt = 1e6 in one step: forward Euler would end at -5.8e6. The limit is A/(tau_0 alpha
// gamma_dot).
TEST(FlocculationUpdate, NeitherOvershootsNorTurnsNegativeInAStiffStep) {
  for (const Thixotropy& t : {roussel, gated}) {
    const double gamma_dot = 1e6 / alpha, floor = !gate(t.kinetics) ? t.A_thix / tau_0 / 1e6 : 0.0;
    double lambda = 5.78;
    for (int i = 0; i < 5; ++i) {
      const double next = flocculation_step(lambda, t, tau_0, gamma_dot, gamma_dot, 1.0);
      const auto rate = [&](double) { return gamma_dot; };
      EXPECT_NEAR(flocculation_step_along(lambda, t, tau_0, rate, 0.0, gamma_dot, gamma_dot, 1.0), next,
                  1e-15);
      EXPECT_GE(next, 0.0);
      EXPECT_LE(next, lambda * (1.0 + 1e-13));
      EXPECT_NEAR(next, floor, 1e-15);
      lambda = next;
    }
  }
}

// However the rate runs and however long the step is, lambda stays within 0 and what the build-up alone would
// give: the worst histories are rates that jump between 0 and 50 1/s at every place that the update asks.
TEST(FlocculationUpdate, StaysPositiveAndBoundedForEveryStepAndRate) {
  for (const Thixotropy& t : {roussel, gated})
    for (double k = 1e-10; k < 2e6; k *= 10.0)
      for (unsigned pattern = 0; pattern < 256; ++pattern) {
        const double dt = k / (alpha * 50.0), most = 2.0 + t.A_thix / tau_0 * dt;
        const auto rate = [&](double time) {
          return pattern >> static_cast<unsigned>(std::lround(7.0 * time / dt)) & 1u ? 50.0 : 0.0;
        };
        for (const double lambda :
             {flocculation_step(2.0, t, tau_0, rate(0.0), rate(dt), dt),
              flocculation_step_along(2.0, t, tau_0, rate, 0.0, rate(0.0), rate(dt), dt)}) {
          EXPECT_GE(lambda, 0.0);
          EXPECT_LE(lambda, most * (1.0 + 1e-12));
        }
      }
}

using Update = double (*)(const ShearPiece&, const Thixotropy&, double lambda, double start, double dt);

double from_ends(const ShearPiece& p, const Thixotropy& t, double lambda, double start, double dt) {
  return flocculation_step(lambda, t, tau_0, p.rate(start), p.rate(start + dt), dt);
}

double along(const ShearPiece& p, const Thixotropy& t, double lambda, double start, double dt) {
  return flocculation_step_along(lambda, t, tau_0, p.rate, start, p.rate(start), p.rate(start + dt), dt);
}

/// lambda after `steps` equal steps over the piece.
double march(const ShearPiece& piece, const Thixotropy& t, double lambda, int steps,
             Update update = from_ends) {
  const double dt = piece.duration / steps;
  for (int i = 0; i < steps; ++i) lambda = update(piece, t, lambda, i * dt, dt);
  return lambda;
}

/// Observed order between two numbers of steps against CVODE at its reference tolerance.
double observed_order(const ShearPiece& piece, const Thixotropy& t, int coarse, int fine,
                      Update update = from_ends) {
  const double exact =
      flocculation_ode(std::vector{piece}, t, tau_0, 5.0, std::vector{piece.duration}).lambda.front();
  const double e_coarse = std::abs(march(piece, t, 5.0, coarse, update) - exact);
  const double e_fine = std::abs(march(piece, t, 5.0, fine, update) - exact);
  return std::log(e_coarse / e_fine) / std::log(static_cast<double>(fine) / coarse);
}

const ShearPiece wave{7.0, [](double t) { return 5.0 + 4.0 * std::sin(1.7 * t); }};
const ShearPiece pulse{4.0, [](double t) { return 12.0 * std::exp(-2.0 * (t - 1.5) * (t - 1.5)) + 0.2; }};
const ShearPiece wave_to_zero{9.0, [](double t) { return 2.0 - 2.0 * std::cos(1.3 * t); }};
const ShearPiece ramp{10.0, [](double t) { return 0.2 + t; }};

TEST(FlocculationUpdate, IsOfSecondOrderOnSmoothHistories) {
  for (const ShearPiece& piece : {wave, pulse})
    EXPECT_NEAR(observed_order(piece, roussel, 80, 640), 2.0, 0.1);
  // Gated and always above gamma_c; the trapezium of a linear rate is exact, so only the curved ones show an
  // order.
  for (const ShearPiece& piece : {wave, pulse}) {
    const double order = observed_order(piece, gated, 40, 160);
    EXPECT_GE(order, 1.9);
  }
}

// A linear rate breaks down exactly; the build-up's mean of an exponential is off by (c/dt)^2 dt^5 with c =
// alpha dt (g1 - g0)/2 the asymmetry: order 4, and at ten steps of 1 s, c = 0.018, far below what is built up
// in a step, 0.024, times c^2/360.
TEST(FlocculationUpdate, IsOfFourthOrderAtALinearRate) {
  EXPECT_NEAR(observed_order(ramp, roussel, 2, 8), 4.0, 0.2);
  const double exact =
      flocculation_ode(std::vector{ramp}, roussel, tau_0, 5.0, std::vector{10.0}).lambda.front();
  EXPECT_NEAR(march(ramp, roussel, 5.0, 10), exact, 10 * 0.024 * 0.018 * 0.018 / 360.0);
}

// Lobatto's rule of four points is of order 6, and so is what is left out of the build-up. The coarse steps
// are as long as the history allows, the fine ones stay ten times above CVODE's own error, about 1e-11, which
// may shift the order by 0.15.
TEST(FlocculationUpdate, IsOfSixthOrderAlongAHistory) {
  EXPECT_NEAR(observed_order(wave, roussel, 14, 28, along), 6.0, 0.3);
  EXPECT_NEAR(observed_order(wave, gated, 14, 28, along), 6.0, 0.3);
  const ShearPiece half_a_pulse{1.9, pulse.rate};  // over all of it the errors of both flanks cancel
  EXPECT_NEAR(observed_order(half_a_pulse, roussel, 8, 16, along), 6.0, 0.2);
}

// Rest - flow - rest through the gate with steps that do not end on the crossings: the step is split there,
// and under a linear rate each part is exact, so the update meets CVODE (root-finding) to the reference's own
// error.
TEST(FlocculationUpdate, MeetsCvodeThroughTheGate) {
  const std::vector<ShearSegment> segments{
      {100.0, 0.0, 0.0}, {3.0, 0.0, 12.0}, {2.0, 12.0, 12.0}, {3.0, 12.0, 0.0}, {60.0, 0.0, 0.0}};
  const auto history = linear_pieces(segments);
  double lambda = 0.0;
  for (const ShearPiece& piece : history) lambda = march(piece, gated, lambda, 7);
  const auto reference = flocculation_ode(history, gated, tau_0, 0.0, std::vector{duration(history)});
  EXPECT_EQ(reference.gate_crossings, 2);
  EXPECT_NEAR(lambda, reference.lambda.front(), 1e-10);
}

// A curved rate through the gate: the split point comes from the chord, an O(dt^2) error, so the order
// stays 2.
TEST(FlocculationUpdate, KeepsItsOrderThroughTheGate) {
  EXPECT_GE(observed_order(wave_to_zero, gated, 100, 1600), 1.8);
}

// Along the history the crossings are found on the rate itself, so that steps of 1 s are as good through the
// gate as without it; a dip of 0.4 s that lies inside one step is seen as well.
TEST(FlocculationUpdate, MeetsCvodeThroughTheGateAlongAHistory) {
  const ShearPiece dip{2.0,
                       [](double t) { return 0.05 + (t - 0.9) * (t - 0.9); }};  // below 0.1 within 0.22 s
  const auto error = [](const ShearPiece& piece, int steps) {
    const auto reference =
        flocculation_ode(std::vector{piece}, gated, tau_0, 5.0, std::vector{piece.duration});
    EXPECT_GE(reference.gate_crossings, 2);
    return std::abs(march(piece, gated, 5.0, steps, along) - reference.lambda.front());
  };
  EXPECT_LT(error(wave_to_zero, 9), 2e-6);
  EXPECT_LT(error(wave_to_zero, 36), 1e-9);
  for (const int steps : {1, 2, 3})
    EXPECT_LT(error(dip, steps), 1e-9);  // a cubic is exact, whatever the step
}

TEST(FlocculationUpdate, RestInClosedFormIsTheStepAtRest) {
  EXPECT_DOUBLE_EQ(flocculation_after_rest(0.0, roussel, tau_0, 240.0), 1.3 * 240.0 / 54.0);
  EXPECT_DOUBLE_EQ(flocculation_after_rest(0.3, gated, tau_0, 240.0),
                   flocculation_step(0.3, gated, tau_0, 0.0, 0.0, 240.0));
}

}  // namespace
}  // namespace tremie
