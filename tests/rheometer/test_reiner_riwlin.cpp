// Reiner-Riwlin between concentric cylinders, against published torques and against its own closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie {
namespace {

constexpr double pi = std::numbers::pi;
const Bingham mix_a{54.0, 35.8}, mix_b{61.0, 29.0}, mix_c{130.0, 30.2};

// Torques at 0.25 and 0.5 rev/s in the ICAR geometry, computed independently and stated to three or four
// digits.
TEST(ReinerRiwlin, GivesTheStatedTorquesToThreeDigits) {
  const double slow = angular_speed(0.25);
  EXPECT_NEAR(reiner_riwlin(mix_a, slow).torque, 0.801, 5e-4);
  EXPECT_NEAR(reiner_riwlin(mix_b, slow).torque, 0.753, 5e-4);
  EXPECT_NEAR(reiner_riwlin(mix_c, slow).torque, 1.145, 5e-4);
  EXPECT_NEAR(reiner_riwlin(mix_a, angular_speed(0.5)).torque, 1.253, 5e-4);
  const double lambda = 1.3 * 240.0 / 54.0;
  EXPECT_NEAR(reiner_riwlin({(1.0 + lambda) * 54.0, 35.8}, slow).torque, 2.356, 5e-4);
}

TEST(ReinerRiwlin, MixAHasItsPlugFrom136Millimetres) {
  const CouetteState s = reiner_riwlin(mix_a, angular_speed(0.25));
  EXPECT_TRUE(s.plug);
  EXPECT_NEAR(s.sheared_radius, 0.136, 5e-4);
  EXPECT_FALSE(reiner_riwlin(mix_a, angular_speed(0.5)).plug);
}

// The flow between the cylinders satisfies its own definition: Omega is the integral of gamma_dot/r over the
// sheared gap, with gamma_dot from the Bingham law. Simpson's rule on 2000 intervals is exact to 1e-10 here.
TEST(ReinerRiwlin, IntegratesTheShearRateToTheSpeed) {
  const Instrument in;
  for (const double revolutions : {0.01, 0.25, 0.5}) {
    const CouetteState s = reiner_riwlin(mix_a, angular_speed(revolutions), in);
    const int n = 2000;
    const double dr = (s.sheared_radius - in.vane_radius) / n;
    double speed = 0.0;
    for (int i = 0; i <= n; ++i) {
      const double r = in.vane_radius + i * dr;
      const double gamma_dot = (shear_stress_at(r, s.torque, in) - mix_a.tau_0) / mix_a.mu;
      speed += (i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0) * gamma_dot / r * dr / 3.0;
    }
    EXPECT_NEAR(speed / angular_speed(revolutions), 1.0, 1e-9) << revolutions;
  }
}

// Newtonian: T = 4 pi h mu Omega / (R_i^-2 - R_o^-2), Margules.
TEST(ReinerRiwlin, HasTheNewtonianLimit) {
  const Instrument in;
  const double a =
      1.0 / (in.vane_radius * in.vane_radius) - 1.0 / (in.container_radius * in.container_radius);
  const double margules = 4.0 * pi * in.vane_height * 40.0 * 2.0 / a;
  EXPECT_NEAR(reiner_riwlin({0.0, 40.0}, 2.0, in).torque, margules, 1e-14 * margules);
  EXPECT_NEAR(reiner_riwlin({1e-9, 40.0}, 2.0, in).torque, margules, 1e-9);
}

// As the speed goes to 0 the layer at the vane is thin, y - ln(1+y) -> y^2/2, so T = T_y (1 + sqrt(4 mu
// Omega/tau_0)).
TEST(ReinerRiwlin, TendsToTheYieldTorqueAtLowSpeed) {
  const Instrument in;
  const double yield_torque = 2.0 * pi * in.vane_height * in.vane_radius * in.vane_radius * mix_a.tau_0;
  EXPECT_NEAR(reiner_riwlin(mix_a, 0.0, in).torque, yield_torque, 1e-15);
  EXPECT_NEAR(reiner_riwlin({54.0, 0.0}, 3.0, in).torque, yield_torque, 1e-15);
  for (const double omega : {1e-20, 1e-14, 1e-10}) {
    const double y = std::sqrt(4.0 * mix_a.mu * omega / mix_a.tau_0);
    // the next term of the series is y^2/3
    EXPECT_NEAR(reiner_riwlin(mix_a, omega, in).torque / yield_torque - 1.0, y + y * y / 3.0, 1e-12) << omega;
  }
}

TEST(ReinerRiwlin, TorqueIsContinuousWhereThePlugVanishes) {
  const Instrument in;
  const double ratio = in.container_radius / in.vane_radius;
  const double torque = 2.0 * pi * in.vane_height * in.container_radius * in.container_radius * mix_a.tau_0;
  const double omega = mix_a.tau_0 / (2.0 * mix_a.mu) * (ratio * ratio - 1.0 - 2.0 * std::log(ratio));
  const CouetteState below = reiner_riwlin(mix_a, omega * (1.0 - 1e-9), in);
  const CouetteState above = reiner_riwlin(mix_a, omega * (1.0 + 1e-9), in);
  EXPECT_TRUE(below.plug);
  EXPECT_FALSE(above.plug);
  EXPECT_NEAR(below.torque, torque, 2e-9);
  EXPECT_NEAR(above.torque, torque, 2e-9);
}

TEST(ReinerRiwlin, SpeedAndTorqueAreInverse) {
  for (const Bingham& mix : {mix_a, mix_b, mix_c, Bingham{0.0, 30.0}, Bingham{800.0, 5.0}})
    for (const double omega : {1e-6, 1e-2, 0.5, 1.57, 6.0})
      EXPECT_NEAR(reiner_riwlin_speed(mix, reiner_riwlin(mix, omega).torque) / omega, 1.0, 1e-10) << omega;
  EXPECT_EQ(reiner_riwlin_speed(mix_a, 0.01), 0.0);  // below the yield torque nothing turns
}

// Central differences of the torque; their truncation and rounding are below 1e-6 of the slope at this step.
TEST(ReinerRiwlin, DerivativesMatchDifferences) {
  for (const double omega : {0.05, 1.57, 3.5}) {
    const CouetteState s = reiner_riwlin(mix_a, omega);
    const double e = 1e-4;
    const auto torque = [&](double tau_0, double mu) { return reiner_riwlin({tau_0, mu}, omega).torque; };
    EXPECT_NEAR((torque(54 + e, 35.8) - torque(54 - e, 35.8)) / (2 * e) / s.d_torque_d_tau_0, 1.0, 1e-6);
    EXPECT_NEAR((torque(54, 35.8 + e) - torque(54, 35.8 - e)) / (2 * e) / s.d_torque_d_mu, 1.0, 1e-6);
  }
}

std::vector<FlowPoint> flow_curve(const Bingham& mix, const std::vector<double>& speeds) {
  std::vector<FlowPoint> points;
  for (const double omega : speeds) points.push_back({omega, reiner_riwlin(mix, omega).torque});
  return points;
}

void expect_round_trip(const Bingham& mix, const std::vector<double>& speeds) {
  const std::vector<FlowPoint> points = flow_curve(mix, speeds);
  const Bingham found = bingham_from_flow_curve(points);
  EXPECT_NEAR(found.mu / mix.mu, 1.0, 1e-10);
  EXPECT_NEAR(found.tau_0, mix.tau_0, 1e-10 * std::max(mix.tau_0, 1.0));
  for (const FlowPoint& p : points) EXPECT_NEAR(reiner_riwlin(found, p.omega).torque / p.torque, 1.0, 1e-10);
}

TEST(ReinerRiwlin, ParametersComeBackFromTorques) {
  for (const Bingham& mix : {mix_a, mix_b, mix_c}) {
    expect_round_trip(mix, {3.6, 4.0, 5.0, 6.0});        // fully sheared (A and B)
    expect_round_trip(mix, {0.05, 0.1, 0.2, 0.4, 0.8});  // plug at every speed
    expect_round_trip(mix, {0.3, 3.14, 6.0});            // plug at some
    expect_round_trip(mix, {0.3, 3.14});                 // two points: solved exactly
  }
}

TEST(ReinerRiwlin, ParametersComeBackInTheNewtonianLimit) { expect_round_trip({0.0, 25.0}, {0.5, 1.0, 3.0}); }

// A millimetre at the vane is sheared: the torque is the yield torque and some per cent.
TEST(ReinerRiwlin, ParametersComeBackFromAThinLayer) {
  expect_round_trip({54.0, 0.05}, {0.05, 0.1, 0.2, 0.3, 0.4, 0.5});
  expect_round_trip({54.0, 0.005}, {0.05, 0.1, 0.2, 0.3, 0.4, 0.5});
}

TEST(ReinerRiwlin, NeverReportsANegativeParameter) {
  const std::vector<FlowPoint> falling{{1.0, 2.0}, {2.0, 1.5}, {3.0, 1.0}};
  const std::vector<FlowPoint> steeper_than_newtonian{{1.0, 0.1}, {2.0, 1.5}, {3.0, 4.0}};
  EXPECT_EQ(bingham_from_flow_curve(falling).mu, 0.0);
  EXPECT_EQ(bingham_from_flow_curve(steeper_than_newtonian).tau_0, 0.0);
}

TEST(ReinerRiwlin, RefusesWhatHasNoMeaning) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(reiner_riwlin({-1.0, 1.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(reiner_riwlin({1.0, nan}, 1.0), std::invalid_argument);
  EXPECT_THROW(reiner_riwlin(mix_a, -1.0), std::invalid_argument);
  EXPECT_THROW(reiner_riwlin(mix_a, 1.0, {0.1, 0.1, 0.1}), std::invalid_argument);
  EXPECT_THROW(bingham_from_flow_curve(std::vector<FlowPoint>{{1.0, 1.0}}), std::invalid_argument);
  EXPECT_THROW(bingham_from_flow_curve(std::vector<FlowPoint>{{1.0, 1.0}, {1.0, 1.1}}),
               std::invalid_argument);
  EXPECT_THROW(bingham_from_flow_curve(std::vector<FlowPoint>{{1.0, 1.0}, {2.0, -1.1}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace tremie
