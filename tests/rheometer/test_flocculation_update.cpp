// The per-point update of lambda (libmpm/law/flocculation.hpp) against closed forms and against CVODE.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "libmpm/law/flocculation.hpp"
#include "rheometer/flocculation_ode.hpp"

namespace tremie {
namespace {

constexpr double tau_0 = 54.0;
const Thixotropy roussel{1.3, 0.0358, Kinetics::roussel, 0.1, 0.0};
const Thixotropy gated{1.3, 0.0358, Kinetics::gated, 0.1, 0.0};

double closed_form(double lambda_0, const Thixotropy& t, double gamma_dot, double time) {
  const long double k = static_cast<long double>(t.alpha) * gamma_dot * time;
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
    }
}

// alpha gamma_dot dt = 1e6 in one step: forward Euler would end at -5.8e6. The limit is A/(tau_0 alpha
// gamma_dot).
TEST(FlocculationUpdate, NeitherOvershootsNorTurnsNegativeInAStiffStep) {
  for (const Thixotropy& t : {roussel, gated}) {
    const double gamma_dot = 1e6 / t.alpha,
                 floor = t.kinetics == Kinetics::roussel ? t.A_thix / tau_0 / 1e6 : 0.0;
    double lambda = 5.78;
    for (int i = 0; i < 5; ++i) {
      const double next = flocculation_step(lambda, t, tau_0, gamma_dot, gamma_dot, 1.0);
      EXPECT_GE(next, 0.0);
      EXPECT_LE(next, lambda * (1.0 + 1e-13));
      EXPECT_NEAR(next, floor, 1e-15);
      lambda = next;
    }
  }
}

/// lambda after `steps` equal steps over the piece.
double march(const ShearPiece& piece, const Thixotropy& t, double lambda, int steps) {
  const double dt = piece.duration / steps;
  for (int i = 0; i < steps; ++i)
    lambda = flocculation_step(lambda, t, tau_0, piece.rate(i * dt), piece.rate((i + 1) * dt), dt);
  return lambda;
}

/// Observed order between two numbers of steps against CVODE.
double observed_order(const ShearPiece& piece, const Thixotropy& t, int coarse, int fine) {
  const double exact =
      flocculation_ode(std::vector{piece}, t, tau_0, 5.0, std::vector{piece.duration}).lambda.front();
  const double e_coarse = std::abs(march(piece, t, 5.0, coarse) - exact);
  const double e_fine = std::abs(march(piece, t, 5.0, fine) - exact);
  return std::log(e_coarse / e_fine) / std::log(static_cast<double>(fine) / coarse);
}

TEST(FlocculationUpdate, IsOfSecondOrderOnSmoothHistories) {
  const ShearPiece wave{7.0, [](double t) { return 5.0 + 4.0 * std::sin(1.7 * t); }};
  const ShearPiece pulse{4.0, [](double t) { return 12.0 * std::exp(-2.0 * (t - 1.5) * (t - 1.5)) + 0.2; }};
  const ShearPiece ramp{10.0, [](double t) { return 0.2 + t; }};
  for (const ShearPiece& piece : {wave, pulse, ramp})
    EXPECT_NEAR(observed_order(piece, roussel, 80, 640), 2.0, 0.1);
  // Gated and always above gamma_c; the trapezium of a linear rate is exact, so only the curved ones show an
  // order.
  for (const ShearPiece& piece : {wave, pulse}) {
    const double order = observed_order(piece, gated, 40, 160);
    EXPECT_GE(order, 1.9);
  }
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
  const ShearPiece wave{9.0, [](double t) { return 2.0 - 2.0 * std::cos(1.3 * t); }};
  EXPECT_GE(observed_order(wave, gated, 100, 1600), 1.8);
}

TEST(FlocculationUpdate, RestInClosedFormIsTheStepAtRest) {
  EXPECT_DOUBLE_EQ(flocculation_after_rest(0.0, roussel, tau_0, 240.0), 1.3 * 240.0 / 54.0);
  EXPECT_DOUBLE_EQ(flocculation_after_rest(0.3, gated, tau_0, 240.0),
                   flocculation_step(0.3, gated, tau_0, 0.0, 0.0, 240.0));
}

}  // namespace
}  // namespace tremie
