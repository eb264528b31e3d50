// The 95 % intervals of the fit over 200 noisy records of a known material (2 % of the reading): the truth
// must lie inside in 90 to 98 % of them. Binomial scatter at 95 % and 200 records is 1.5 %, so an honest
// interval passes and one that is 30 % too narrow (81 %) or 60 % too wide (99.8 %) does not.

#include <gtest/gtest.h>

#include <cstdio>

#include "rheometer/regression/statistics.hpp"
#include "tests/verification/fit_coverage.hpp"

namespace tremie::study {
namespace {

constexpr int seeds = 200;

void expect_honest(const std::vector<Coverage>& coverage) {
  for (const Coverage& c : coverage) {
    EXPECT_GE(c.covered, seeds * 90 / 100) << c.name;
    EXPECT_LE(c.covered, seeds * 98 / 100) << c.name;
    EXPECT_EQ(c.missing, 0) << c.name;
  }
}

TEST(FitCoverage, FlowCurvesOf7And20And200Readings) {
  for (const int readings : {7, 20, 200}) expect_honest(flow_curve_coverage(readings, 0.02, seeds));
}

TEST(FitCoverage, TorqueDecayOfAKnownDynamicMaterial) {
  const auto coverage = decay_coverage(true, 0.02, seeds);
  expect_honest(coverage);
  EXPECT_NEAR(median(coverage[1].values) / synthetic::alpha, 1.0, 0.05);
}

TEST(FitCoverage, TorqueDecayWithTheYieldStressUnknown) {
  const auto coverage = decay_coverage(false, 0.02, seeds);
  expect_honest(coverage);
  EXPECT_NEAR(median(coverage[1].values) / synthetic::alpha, 1.0, 0.05);
}

// Correlated noise and drift as instruments have them. The drift is a part of the record that no interval knows of, so
// 90 to 99 % are asked for. "does not fit" may come up in 2 % of records of the right model.
TEST(FitCoverage, TorqueDecaysWithCorrelatedNoiseAndDrift) {
  for (const Noise& kind : {Noise{0.9, 0.0}, Noise{0.6, 0.005}, Noise{0.6, 0.0}, Noise{0.0, 0.0}}) {
    int alarms = 0;
    const auto coverage = decay_coverage(
        true, 0.02, seeds, [&](const FitResult& f) { alarms += !f.reasons.empty(); }, kind);
    std::printf("rho %.1f, drift %.1f %%: %d alarms;", kind.rho, 100.0 * kind.drift, alarms);
    for (const Coverage& c : coverage) {
      const int told = seeds - c.missing;
      std::printf(" %s %.1f %% of %d", c.name.c_str(), 100.0 * c.covered / told, told);
      EXPECT_GE(c.covered, told * 90 / 100) << c.name;
      EXPECT_LE(c.covered, told * 99 / 100) << c.name;
      EXPECT_LE(c.missing, seeds * 2 / 100) << c.name;
    }
    std::printf("\n");
    EXPECT_LE(alarms, seeds * 2 / 100);
  }
}

}  // namespace
}  // namespace tremie::study
