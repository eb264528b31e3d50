// Which law a flow curve gets, and what its intervals claim. Curves are closed forms in an even shear, written here.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "rheometer/fits/fit.hpp"
#include "rheometer/fits/parameters.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/whole_fit/replicates.hpp"

namespace tremie {
namespace {

/// tau_0 + k rate^n over the rates, each stress times 1 + its error.
TorqueRecord stresses(const std::vector<double>& rates, double tau_0, double k, double n,
                      const std::vector<double>& error) {
  TorqueRecord record;
  record.sheared_evenly = true;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    record.omega.push_back(rates[i] * evenly_sheared_speed);
    record.torque.push_back((tau_0 + k * std::pow(rates[i], n)) * (1.0 + error[i]));
    record.line.push_back(static_cast<long>(i) + 2);
  }
  return record;
}

FitInput evenly(const char* law) {
  FitInput in;
  in.instrument = evenly_sheared();
  in.law = law;
  return in;
}

std::vector<double> even_rates(std::size_t n) {
  std::vector<double> rates;
  for (std::size_t i = 0; i < n; ++i)
    rates.push_back(1.0 + 50.0 * static_cast<double>(i) / static_cast<double>(n - 1));
  return rates;
}

/// Noise of one standard deviation whose neighbours correlate by rho.
std::vector<double> noise(std::size_t n, double rho, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> v(n);
  double state = normal(generator);
  for (double& x : v) {
    x = state;
    state = rho * state + std::sqrt(1.0 - rho * rho) * normal(generator);
  }
  return v;
}

std::vector<double> scaled(std::vector<double> v, double factor) {
  for (double& x : v) x *= factor;
  return v;
}

// Six readings at the speeds of an oil-field viscometer, 0.7 % off Herschel-Bulkley's 6 Pa, 1.1 Pa s^0.5, 0.5: Bingham misses
// them by 8 %. An F test of 1 and 3 degrees of freedom leaves no doubt; Akaike's small-sample term (30 for the third
// parameter) kept Bingham.
TEST(LawChoice, SixReadingsOfASpacerFluidAreHerschelBulkley) {
  const std::vector<double> rates{5.11, 10.2, 170.0, 341.0, 511.0, 1022.0};
  const TorqueRecord record = stresses(rates, 6.0, 1.1, 0.5, {0.007, -0.007, 0.007, -0.007, -0.007, 0.007});
  for (const char* law : {"auto", "bingham"}) {
    const FitResult f = fit(record, evenly(law));
    EXPECT_EQ(f.model, "herschel_bulkley") << law;
    EXPECT_TRUE(f.reasons.empty());
    ASSERT_TRUE(f.tau_0 && f.tau_0->ci95);
    EXPECT_NEAR(f.tau_0->value, 6.0, 0.7);
    EXPECT_TRUE(f.tau_0->ci95->low < 6.0 && 6.0 < f.tau_0->ci95->high);
  }
}

// One stray reading at the end bends a line: the law is judged on what both laws keep.
TEST(LawChoice, ADroppedOutlierDoesNotDecide) {
  std::vector<double> error = scaled(noise(12, 0.0, 7), 0.005);
  error.back() = 0.3;
  const FitResult f = fit(stresses(even_rates(12), 54.0, 5.0, 1.0, error), evenly("auto"));
  EXPECT_EQ(f.model, "bingham");
  EXPECT_EQ(f.dropped_count, 1);
}

// A test at 1 % takes Herschel-Bulkley for Bingham in 1 % of records; 5 of 200 or fewer in 98 % of trials.
TEST(LawChoice, ABinghamRecordIsSeldomTakenForAnother) {
  int wrong = 0;
  for (unsigned seed = 1; seed <= 200; ++seed)
    wrong += fit(stresses(even_rates(8), 54.0, 5.0, 1.0, scaled(noise(8, 0.0, seed), 0.02)), evenly("auto"))
                 .model != "bingham";
  EXPECT_LE(wrong, 5);
}

// 800 readings whose noise correlates by 0.73: (1 - rho)/(1 + rho) of them, 125, are independent.
TEST(LawChoice, CorrelatedReadingsCountAsFewer) {
  const FitResult f =
      fit(stresses(even_rates(800), 54.0, 5.0, 1.0, scaled(noise(800, 0.73, 3), 0.02)), evenly("bingham"));
  EXPECT_NEAR(f.effective_readings, 125.0, 40.0);
  const FitResult white =
      fit(stresses(even_rates(800), 54.0, 5.0, 1.0, scaled(noise(800, 0.0, 3), 0.02)), evenly("bingham"));
  EXPECT_EQ(white.effective_readings, 800.0);
  const double wide = f.tau_0->ci95->high - f.tau_0->ci95->low,
               narrow = white.tau_0->ci95->high - white.tau_0->ci95->low;
  EXPECT_NEAR(wide / narrow, std::sqrt(800.0 / 125.0), 0.8);
}

// Five readings of a law that has three parameters: what is told by an interval is in no note of what is not told.
TEST(LawChoice, NoParameterIsBothToldAndUntold) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const FitResult f = fit(stresses(even_rates(5), 5.0, 5.0, 0.6, scaled(noise(5, 0.0, seed), 0.05)),
                            evenly("herschel_bulkley"));
    for (const FitParameter& p : parameters_of(f)) {
      if (!value_of(f, p)) continue;
      for (const std::string& note : f.notes)
        EXPECT_FALSE(note.find("not identifiable from this record") != std::string::npos &&
                     note.find(p.name) != std::string::npos)
            << note;
    }
  }
}

// The same record three times scatters by nothing, and claims no more than once.
TEST(Replicates, AreNeverSurerThanTheirParts) {
  const FitResult f =
      fit(stresses(even_rates(20), 54.0, 5.0, 1.0, scaled(noise(20, 0.0, 5), 0.02)), evenly("bingham"));
  for (const std::vector<FitResult>& fits : {std::vector{f, f, f}, std::vector{f}})
    for (const ReplicateMean& m : replicate_means(fits)) {
      ASSERT_TRUE(m.mean.ci95);
      const auto part = value_of(f, m.parameter);
      EXPECT_GE(m.mean.ci95->high - m.mean.ci95->low, 0.999 * (part->ci95->high - part->ci95->low));
    }
}

// White noise is left alone in 19 of 20 records; rho = 0.7 on 200 readings inflates by (1 + rho)/(1 - rho) = 5.7.
TEST(CorrelatedNoise, IsToldFromWhiteNoise) {
  EXPECT_EQ(correlated_noise(0.05, 200.0, 2.0).inflation, 1.0);
  EXPECT_NEAR(correlated_noise(0.7, 1e6, 2.0).inflation, 1.7 / 0.3, 1e-3);
  EXPECT_NEAR(correlated_noise(0.7, 1e6, 2.0).independent, 1e6 * 0.3 / 1.7, 1e3);
}

}  // namespace
}  // namespace tremie
