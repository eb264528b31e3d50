// k and a by the times that a torque's excess takes to halve, modes, and peaks that saturate with rest.

#include <gtest/gtest.h>

#include <cmath>

#include "rheometer/protocol/breakdown.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie {
namespace {

const Instrument instrument{.vane_radius = 0.02, .vane_height = 0.06, .container_radius = 0.05};

/// 30 s of 0.03 + excess e^(-k gamma_dot^a t) N m, every 0.01 s.
Fall fall_at(double omega, double k, double a, double excess = 0.2) {
  const double rate = k * std::pow(newtonian_shear_rate(omega, instrument), a);
  Fall f{omega, {}, {}, 1};
  for (int i = 0; i <= 30000; ++i) {
    f.time.push_back(0.01 * i);
    f.torque.push_back(0.03 + excess * std::exp(-rate * f.time.back()));
  }
  return f;
}

TEST(Breakdown, TwoSpeedsTellRateAndExponent) {
  const Breakdown b = breakdown_of({fall_at(4.2, 0.3, 0.15), fall_at(0.05, 0.3, 0.15, 0.1)}, instrument);
  ASSERT_TRUE(b.rate && b.exponent);
  EXPECT_NEAR(b.exponent->value, 0.15, 1e-3);
  EXPECT_NEAR(b.rate->value, 0.3, 1e-3);
  EXPECT_FALSE(b.exponent->ci95);  // two decays leave no scatter to judge by
  const Breakdown three = breakdown_of(
      {fall_at(4.2, 0.3, 0.15), fall_at(0.05, 0.29, 0.15), fall_at(0.5, 0.31, 0.15)}, instrument);
  ASSERT_TRUE(three.exponent->ci95);
  EXPECT_LT(three.exponent->ci95->low, 0.15);
  EXPECT_GT(three.exponent->ci95->high, 0.15);
}

TEST(Breakdown, OneSpeedTellsNoExponent) {
  const Breakdown b = breakdown_of({fall_at(4.2, 0.3, 0.15), fall_at(4.3, 0.3, 0.15)}, instrument);
  EXPECT_EQ(b.times.size(), 2u);
  EXPECT_FALSE(b.exponent);
  EXPECT_FALSE(b.rate);
  EXPECT_EQ(b.notes.size(), 1u);
}

TEST(Breakdown, ALevelTorqueHasNoHalfTime) { EXPECT_FALSE(excess_half_time(fall_at(4.2, 0.3, 0.15, 0.001))); }

// sum share e^(-factor rate t) is (1 + t/t_0)^-m within 0.03, by the width of a mode.
TEST(Breakdown, ModesAreAGammaDistributionOfRates) {
  for (const double m : {0.4, 1.0, 2.5}) {
    const double t_0 = 0.7, rate = std::numbers::ln2 / (t_0 * (std::pow(2.0, 1.0 / m) - 1.0));
    const auto modes = modes_of_gamma(m, t_0, rate);
    for (double t = 0.01 / rate; t < 100.0 / rate; t *= 1.5) {
      double sum = 0.0;
      for (const BreakdownMode& mode : modes) sum += mode.share * std::exp(-mode.factor * rate * t);
      EXPECT_NEAR(sum, std::pow(1.0 + t / t_0, -m), 0.03) << m << ' ' << t * rate;
    }
  }
}

// S = 1800 - 1700 e^(-t/300) Pa: the longest rest from the shorter ones.
TEST(Breakdown, PeaksThatSaturate) {
  std::vector<double> rest{30, 60, 120, 240, 480}, stress, line;
  for (const double t : rest) {
    stress.push_back(1800.0 - 1700.0 * std::exp(-t / 300.0));
    line.push_back(100.0 + 3.0 * t);
  }
  const auto s = saturation_of(rest, stress);
  ASSERT_TRUE(s && s->forecast_of_longest);
  EXPECT_NEAR(s->end_stress, 1800.0, 0.1);
  EXPECT_NEAR(s->time, 300.0, 0.1);
  EXPECT_NEAR(*s->forecast_of_longest, stress.back(), 0.1);
  EXPECT_LT(s->chance, 1e-3);
  EXPECT_FALSE(saturation_of(rest, line));
}

}  // namespace
}  // namespace tremie
