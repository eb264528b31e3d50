// What a record does not tell: a torque at the instrument's limit, a decay that hangs on its clock.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "rheometer/fits/fit.hpp"
#include "rheometer/records/torque_limit.hpp"
#include "tests/rheometer/synthetic_record.hpp"

namespace tremie {
namespace {

using namespace synthetic;

std::vector<double> row_numbers(std::size_t n) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = static_cast<double>(i);
  return x;
}

double rounded_to(double value, double step) { return step * std::round(value / step); }

// A decay 3 + 4 e^(-t/20) cut off at 5, its end as flat as its resolution.
TEST(TorqueLimit, APlateauAtTheLargestTorqueIsTold) {
  const std::vector<double> x = row_numbers(100);
  std::vector<double> torque;
  for (const double t : x)
    torque.push_back(std::min(5.0, rounded_to(3.0 + 4.0 * std::exp(-t / 20.0), 0.001)));
  const auto limit = torque_limit(x, torque);
  ASSERT_TRUE(limit);
  EXPECT_EQ(limit->torque, 5.0);
  EXPECT_EQ(limit->rows, 14);  // 20 ln 2 = 13.9 s
}

// Exports round: a flat start of a slow decay, a rounded peak, a level torque and three readings of one speed are no limit.
TEST(TorqueLimit, RoundedTorquesAreNoLimit) {
  const std::vector<double> x = row_numbers(100);
  std::vector<double> slow, peak, level(100, 2.0);
  for (const double t : x) {
    slow.push_back(rounded_to(3.0 + 4.0 * std::exp(-t / 200.0), 0.05));
    peak.push_back(rounded_to(5.0 - 0.001 * (t - 30.0) * (t - 30.0), 0.01));
  }
  EXPECT_FALSE(torque_limit(x, slow));
  EXPECT_FALSE(torque_limit(x, peak));
  EXPECT_FALSE(torque_limit(x, level));
  EXPECT_FALSE(torque_limit({1, 2, 3, 4, 4, 4}, {1.0, 1.4, 1.9, 2.35, 2.35, 2.35}));
}

TEST(TorqueLimit, IsAReasonNotToTrustAFit) {
  TorqueRecord record = flow_curve(12);
  for (double& torque : record.torque) torque = std::min(torque, record.torque[8]);
  const FitResult f = fit(record, {});
  ASSERT_FALSE(f.reasons.empty());
  bool told = false;
  for (const std::string& why : f.reasons) told = told || why.find("limit") != std::string::npos;
  EXPECT_TRUE(told);
  for (const std::string& why : fit(flow_curve(12), {}).reasons)
    EXPECT_EQ(why.find("limit"), std::string::npos);
}

/// Whether two answers agree: a value in the other's interval, or one of them is not told.
bool agree(const std::optional<ParameterEstimate>& a, const std::optional<ParameterEstimate>& b) {
  if (!a || !b || !a->ci95 || !b->ci95) return true;
  return a->ci95->low <= b->ci95->high && b->ci95->low <= a->ci95->high;
}

// A torque that falls by a power of the time, as cement pastes' do, at 40 rpm of a vane of 20 mm in 50 mm; neither yield
// stress nor viscosity is known. Its clock moved by the first step of 0.5 s gave alpha 0.004 and 0.025, each with an
// interval of a third.
TEST(FitTorqueDecay, ItsAnswersHoldUnderAShiftOfTheClock) {
  TorqueRecord record;
  record.kind = RecordKind::torque_decay;
  for (const double t : {0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 9.0, 12.0, 15.0}) {
    record.time.push_back(t);
    record.torque.push_back(1e-3 * (8.4 + 9.9 * std::pow(1.0 + t / 0.32, -0.75)));
    record.line.push_back(static_cast<long>(record.line.size()) + 2);
  }
  FitInput in;
  in.instrument = {0.02, 0.06, 0.05};
  in.omega = angular_speed(40.0 / 60.0);
  in.choose_kinetics = true;
  const FitResult f = fit(record, in);
  for (double& t : record.time) t += 0.5;
  const FitResult later = fit(record, in);
  EXPECT_TRUE(agree(f.alpha, later.alpha));
  EXPECT_TRUE(agree(f.tau_0, later.tau_0));
  EXPECT_TRUE(agree(f.mu, later.mu));
  EXPECT_TRUE(agree(f.lambda_0, later.lambda_0));
}

}  // namespace
}  // namespace tremie
