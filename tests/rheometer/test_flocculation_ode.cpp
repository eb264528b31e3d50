// CVODE on the flocculation equation against its closed forms, at the tolerance 1e-12 that makes it a
// reference.
//
// With k(t) = alpha int gamma_dot: constant rate, lambda = lambda_0 e^-k + (A/tau_0) t (1 - e^-k)/k; gated
// breakdown under any rate, lambda = lambda_0 e^-k; rest, lambda_0 + A t/tau_0. A reference has to be much
// better than what it judges (1e-6 to 1e-10), hence 1e-11 of the largest lambda.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "rheometer/reference/flocculation_ode.hpp"

namespace tremie {
namespace {

constexpr double tau_0 = 54.0, tolerance = 1e-11;
constexpr double alpha = 0.0358, gamma_c = 0.1;
const Thixotropy roussel{1.3, RousselKinetics{alpha}};
const Thixotropy gated{1.3, GatedKinetics{alpha, gamma_c}};

std::vector<double> sample_times(double end, int n) {
  std::vector<double> t;
  for (int i = 0; i <= n; ++i) t.push_back(end * i / n);
  return t;
}

std::vector<ShearPiece> segments(const std::vector<ShearSegment>& s) { return linear_pieces(s); }

TEST(FlocculationOde, FollowsTheClosedFormAtConstantRate) {
  for (const double gamma_dot : {0.01, 1.0, 12.43, 500.0}) {
    const auto times = sample_times(20.0, 40);
    const auto result =
        flocculation_ode(segments({{20.0, gamma_dot, gamma_dot}}), roussel, tau_0, 5.78, times);
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double k = alpha * gamma_dot * times[i];
      const double build = k > 0.0 ? -std::expm1(-k) / k : 1.0;
      const double exact = 5.78 * std::exp(-k) + roussel.A_thix / tau_0 * times[i] * build;
      EXPECT_NEAR(result.lambda[i], exact, tolerance * 5.78) << gamma_dot << " 1/s at " << times[i] << " s";
    }
  }
}

TEST(FlocculationOde, BuildsLinearlyAtRest) {
  const auto result =
      flocculation_ode(segments({{240.0, 0.0, 0.0}}), gated, tau_0, 0.5, std::vector{120.0, 240.0});
  EXPECT_NEAR(result.lambda[0], 0.5 + 1.3 * 120.0 / 54.0, tolerance * 6.0);
  EXPECT_NEAR(result.lambda[1], 0.5 + 1.3 * 240.0 / 54.0, tolerance * 6.0);
}

// Rest 100 s, ramp 0 to 10 1/s in 20 s, hold, ramp down: the gate opens 0.2 s into the ramp and closes 0.2 s
// before the end of the last. Both instants and the decay between them (the area under the rate) are known
// exactly.
TEST(FlocculationOde, FindsTheGateInARamp) {
  const auto history = segments({{100.0, 0.0, 0.0}, {20.0, 0.0, 10.0}, {5.0, 10.0, 10.0}, {20.0, 10.0, 0.0}});
  const auto result = flocculation_ode(history, gated, tau_0, 0.0, std::vector{100.0, 120.0, 125.0, 145.0});
  const double build = 1.3 / 54.0;
  const double at_gate = build * 100.2, ramp_area = 100.0 - 0.5 * 0.2 * 0.1;
  const double after_up = at_gate * std::exp(-0.0358 * ramp_area);
  const double after_hold = after_up * std::exp(-0.0358 * 50.0);
  const double after_down = after_hold * std::exp(-0.0358 * ramp_area) + build * 0.2;
  EXPECT_EQ(result.gate_crossings, 2);
  EXPECT_NEAR(result.lambda[0], build * 100.0, tolerance * at_gate);
  EXPECT_NEAR(result.lambda[1], after_up, tolerance * at_gate);
  EXPECT_NEAR(result.lambda[2], after_hold, tolerance * at_gate);
  EXPECT_NEAR(result.lambda[3], after_down, tolerance * at_gate);
}

// gamma_dot = 2 - 2 cos t crosses gamma_c twice a period: t_c = acos(1 - gamma_c/2) from each zero.
TEST(FlocculationOde, FindsTheGateOfASmoothRate) {
  const double period = 2.0 * std::acos(-1.0);
  const std::vector<ShearPiece> history{{2.0 * period, [](double t) { return 2.0 - 2.0 * std::cos(t); }}};
  const auto result = flocculation_ode(history, gated, tau_0, 3.0, std::vector{period, 2.0 * period});
  const double c = std::acos(1.0 - 0.5 * gamma_c), build = 1.3 / 54.0 * c;
  const auto area = [](double t) { return 2.0 * t - 2.0 * std::sin(t); };
  const double decay = std::exp(-0.0358 * (area(period - c) - area(c)));
  const double first = (3.0 + build) * decay + build, second = (first + build) * decay + build;
  EXPECT_EQ(result.gate_crossings, 4);
  EXPECT_NEAR(result.lambda[0], first, tolerance * 3.0);
  EXPECT_NEAR(result.lambda[1], second, tolerance * 3.0);
}

TEST(FlocculationOde, AHistoryThatStartsOnTheGateMovesToItsSide) {
  const auto rising = flocculation_ode(segments({{1.0, 0.1, 1.1}}), gated, tau_0, 1.0, std::vector{1.0});
  const auto falling = flocculation_ode(segments({{1.0, 0.1, 0.0}}), gated, tau_0, 1.0, std::vector{1.0});
  EXPECT_NEAR(rising.lambda[0], std::exp(-0.0358 * 0.6), tolerance);
  EXPECT_NEAR(falling.lambda[0], 1.0 + 1.3 / 54.0, tolerance);
}

// alpha gamma_dot = 1e6 1/s: after the first microseconds lambda is A/(tau_0 alpha gamma_dot) for the rest of
// the second.
TEST(FlocculationOde, TakesBdfForAStiffHistoryAndAdamsForASoftOne) {
  const Thixotropy stiff{1.3, RousselKinetics{1.0}};
  const auto fast = flocculation_ode(segments({{1.0, 1e6, 1e6}}), stiff, tau_0, 5.0, std::vector{1.0});
  EXPECT_TRUE(fast.used_bdf);
  EXPECT_NEAR(fast.lambda[0], 1.3 / 54.0 / 1e6, tolerance);
  const auto slow = flocculation_ode(segments({{1.0, 1.0, 1.0}}), roussel, tau_0, 5.0, std::vector{1.0});
  EXPECT_FALSE(slow.used_bdf);
}

// Build-up that saturates within a millionth of the piece is as stiff as breakdown: lambda is at its balance, in few steps.
TEST(FlocculationOde, TakesBdfForABuildUpThatSaturatesAtOnce) {
  const PowerKinetics kinetics{.alpha = 0.01, .gamma_c = 10.0, .saturation = 0.001};
  const auto result =
      flocculation_ode(segments({{100.0, 1.0, 1.0}}), {1000.0, kinetics}, 0.001, 1.0, std::vector{100.0});
  EXPECT_TRUE(result.used_bdf);
  EXPECT_NEAR(result.lambda[0], 0.001, 1e-9);
  EXPECT_LT(result.steps, 10'000);  // 1e11 of an explicit method
}

TEST(FlocculationOde, RefusesWhatHasNoMeaning) {
  const auto history = segments({{1.0, 0.0, 1.0}});
  EXPECT_THROW(flocculation_ode(history, gated, 0.0, 0.0, std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW(flocculation_ode(history, gated, tau_0, -1.0, std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW(flocculation_ode(history, gated, tau_0, 0.0, std::vector{2.0}), std::invalid_argument);
  EXPECT_THROW(flocculation_ode(history, gated, tau_0, 0.0, std::vector{0.5, 0.1}), std::invalid_argument);
  EXPECT_THROW(linear_piece({0.0, 1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(linear_piece({1.0, -1.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace tremie
