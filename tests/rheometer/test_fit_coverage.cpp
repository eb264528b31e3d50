// The 95 % intervals of the fit over 200 noisy records of a known material (2 % of the reading): the truth
// must lie inside in 90 to 98 % of them. Binomial scatter at 95 % and 200 records is 1.5 %, so an honest
// interval passes and one that is 30 % too narrow (81 %) or 60 % too wide (99.8 %) does not.

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tremie::study
