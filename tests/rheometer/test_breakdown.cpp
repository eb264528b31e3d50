// k, a and modes by one fit of all falls, the onset of a fall, and peaks that saturate with rest.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "rheometer/protocol/breakdown.hpp"
#include "rheometer/protocol/saturation.hpp"
#include "rheometer/reference/instrument.hpp"
#include "rheometer/regression/random_effects.hpp"

namespace tremie {
namespace {

const Instrument instrument{.vane_radius = 0.02, .vane_height = 0.06, .container_radius = 0.05};

double rate_at(double omega, double k, double a) {
  return k * std::pow(newtonian_shear_rate(omega, instrument), a);
}

/// 0.03 + excess S(t) N m over ten half times of e^(-rate t).
template <class Shape>
Fall fall_of_shape(double omega, double rate, double excess, Shape shape) {
  static std::size_t section = 0;
  Fall f{omega, {}, {}, ++section, false};
  for (int i = 0; i <= 300; ++i) {
    f.time.push_back(0.03 * i / rate);
    f.torque.push_back(0.03 + excess * shape(f.time.back()));
  }
  return f;
}

Fall fall_at(double omega, double k, double a, double excess = 0.2) {
  const double rate = rate_at(omega, k, a);
  return fall_of_shape(omega, rate, excess, [&](double t) { return std::exp(-rate * t); });
}

// Falls without noise: the fit has nothing but rounding to miss by.
TEST(Breakdown, TwoSpeedsTellRateAndExponent) {
  const Breakdown b = breakdown_of({fall_at(4.2, 0.3, 0.15), fall_at(0.05, 0.3, 0.15, 0.1)}, instrument);
  ASSERT_TRUE(b.rate && b.exponent);
  EXPECT_NEAR(b.exponent->value, 0.15, 1e-4);
  EXPECT_NEAR(b.rate->value, 0.3, 1e-4);
  EXPECT_TRUE(b.modes.empty());
  for (const BreakdownTime& t : b.times) EXPECT_NEAR(*t.half_time_by_law, t.half_time, 1e-3 * t.half_time);
}

// Rates that scatter by 10 % about k gamma_dot^a, far more than the readings tell: the interval is as wide as that.
TEST(Breakdown, RatesThatScatterWidenTheInterval) {
  const Breakdown b = breakdown_of({fall_at(4.2, 0.3, 0.15), fall_at(0.05, 0.27, 0.15),
                                    fall_at(0.05, 0.33, 0.15), fall_at(0.5, 0.3, 0.15)},
                                   instrument);
  ASSERT_TRUE(b.exponent->ci95);
  EXPECT_LT(b.exponent->ci95->low, 0.14);
  EXPECT_GT(b.exponent->ci95->high, 0.16);
  EXPECT_LT(b.exponent->ci95->high, 0.4);
}

TEST(Breakdown, OneSpeedTellsNoExponent) {
  const Breakdown b = breakdown_of({fall_at(4.2, 0.3, 0.15), fall_at(4.3, 0.3, 0.15)}, instrument);
  EXPECT_EQ(b.times.size(), 2u);
  EXPECT_FALSE(b.exponent);
  EXPECT_FALSE(b.rate);
  ASSERT_EQ(b.notes.size(), 1u);
  EXPECT_NE(b.notes.front().find("not identifiable"), std::string::npos);
  ASSERT_TRUE(b.times.front().breakdown_rate);
  EXPECT_NEAR(*b.times.front().breakdown_rate, rate_at(4.2, 0.3, 0.15), 1e-4);
}

TEST(Breakdown, ALevelTorqueHasNoHalfTime) { EXPECT_FALSE(excess_half_time(fall_at(4.2, 0.3, 0.15, 0.001))); }

// Two modes, of which the slow one holds another part at each speed, as after another rest.
TEST(Breakdown, ModesAreFoundWhateverEachFallHoldsOfThem) {
  std::vector<Fall> falls;
  for (const auto& [omega, slow] : {std::pair{4.2, 0.3}, std::pair{0.2, 0.1}, std::pair{0.2, 0.2}}) {
    const double rate = rate_at(omega, 0.3, 0.4), part = slow;
    falls.push_back(fall_of_shape(omega, 0.2 * rate, 0.2, [&](double t) {
      return (1.0 - part) * std::exp(-rate * t) + part * std::exp(-0.1 * rate * t);
    }));
  }
  const Breakdown b = breakdown_of(falls, instrument);
  ASSERT_EQ(b.modes.size(), 2u);
  EXPECT_NEAR(b.modes[1].factor, 0.1, 1e-3);
  EXPECT_NEAR(b.modes[1].share, 0.2, 1e-3);
  EXPECT_NEAR(b.rate->value, 0.3, 1e-3);
  EXPECT_NEAR(b.exponent->value, 0.4, 1e-3);
}

// A spectrum of rates, (1 + t/t_0)^-m: two to four modes describe it within 2 %, where one misses by more.
TEST(Breakdown, ModesDescribeAGammaDistributionOfRates) {
  for (const double m : {0.7, 1.0, 2.5}) {
    const auto gamma = [&](double t) { return std::pow(1.0 + t / 0.7, -m); };
    Fall fall = fall_of_shape(4.2, 0.3, 0.2, gamma);
    for (std::size_t i = 0; i < fall.torque.size(); ++i) fall.torque[i] *= i % 2 ? 1.002 : 0.998;
    const Breakdown b = breakdown_of({fall}, instrument);
    EXPECT_GE(b.modes.size(), 2u) << m;
    EXPECT_LT(*b.times.front().scatter, 0.02) << m;
  }
}

// Breakdown by strain is found as such, and the criterion prefers Roussel's law, which has one parameter less.
TEST(Breakdown, KineticsAreComparedByTheirFit) {
  std::vector<Fall> falls{fall_at(4.2, 0.3, 1.0), fall_at(0.5, 0.3, 1.0), fall_at(0.5, 0.3, 1.0, 0.1)};
  for (Fall& f : falls)  // 1 % that alternates, so that there is something to judge by
    for (std::size_t i = 0; i < f.torque.size(); ++i) f.torque[i] *= i % 2 ? 1.01 : 0.99;
  const Breakdown by_strain = breakdown_of(falls, instrument);
  ASSERT_GE(by_strain.candidates.size(), 3u);
  EXPECT_EQ(by_strain.candidates.front().name, "roussel");
  EXPECT_LT(*by_strain.candidates.front().difference, 2.0);
  falls = {fall_at(4.2, 0.3, 0.1), fall_at(0.5, 0.3, 0.1)};
  const Breakdown by_time = breakdown_of(falls, instrument);
  EXPECT_GT(*by_time.candidates.front().difference, 100.0);
  EXPECT_EQ(by_time.choice.rfind("rate_power", 0), 0u) << by_time.choice;
}

// A torque that bends over its peak: 1 - s^2/2 for 1 s, then e^(-2 s); its steepest slope is at the bend.
TEST(Breakdown, AStartUpCountsFromItsSteepFall) {
  Fall f{0.05, {}, {}, 1, true};
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.01 * i;
    f.time.push_back(t);
    f.torque.push_back(t < 1.0 ? 1.0 - 0.5 * t * t : 0.5 * std::exp(-2.0 * (t - 1.0)));
  }
  EXPECT_GT(f.time[onset_of(f)], 0.3);
  EXPECT_LT(f.time[onset_of(f)], 1.0);
  f.start_up = false;
  EXPECT_EQ(onset_of(f), 0u);
}

// Weighted mean of one group against another, closed form: slope (2 - 1)/1, variances 0.01/2 at x = 0 and 0.01 at x = 1.
TEST(LineOfEstimates, UncorrelatedValuesAtTwoPlaces) {
  const LineOfEstimates line =
      line_of_estimates({0.0, 0.0, 1.0}, {0.95, 1.05, 2.0}, {0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01}, 1e6);
  EXPECT_NEAR(line.slope, 1.0, 1e-12);
  EXPECT_NEAR(line.intercept, 1.0, 1e-12);
  EXPECT_NEAR(line.half_of_slope, 1.96 * std::sqrt(0.015), 1e-4);
  EXPECT_EQ(line.between, 0.0);
  // The same values with errors of 1e-3: the variance between is their own, (0.1^2)/2, as far as one degree tells.
  const LineOfEstimates apart =
      line_of_estimates({0.0, 0.0, 1.0}, {0.95, 1.05, 2.0}, {1e-6, 0, 0, 0, 1e-6, 0, 0, 0, 1e-6}, 1e6);
  EXPECT_NEAR(apart.between, std::sqrt(0.005 - 1e-6), 1e-6);
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
  const auto forecasts = forecasts_of(rest, stress);
  ASSERT_EQ(forecasts.size(), 2u);
  for (const PeakForecast& f : forecasts) EXPECT_NEAR(f.forecast, f.measured, 0.5) << f.rest;
}

}  // namespace
}  // namespace tremie
