// Several protocols of one material: their means, the intervals of these, and one law for all. Records are made
// (made_gap.hpp).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "rheometer/tables/text.hpp"
#include "rheometer/whole_fit/fit_record.hpp"
#include "rheometer/whole_fit/protocol_replicates.hpp"
#include "tests/rheometer/made_gap.hpp"

namespace tremie {
namespace {

using made::GapTest;

/// A ramp and three start-ups; yield stress and A_thix by a factor, as samples of one batch differ.
GapTest sample(double factor, unsigned seed, double n = 1.0) {
  GapTest test;
  test.material.n = n, test.material.tau_0 *= factor, test.material.A_thix *= factor;
  test.seed = seed, test.decay_rest = 0.0, test.nodes = 100;
  return test;
}

std::vector<ProtocolReading> readings_of(const std::vector<GapTest>& tests) {
  std::vector<ProtocolReading> readings;
  for (const GapTest& test : tests) readings.push_back(read_protocol(record_of(test), {}));
  return readings;
}

const ReplicateMean& mean_named(const std::vector<ReplicateMean>& means, const std::string& name,
                                const std::string& where = "") {
  const auto found = std::find_if(means.begin(), means.end(), [&](const ReplicateMean& m) {
    return m.parameter.name == name && m.where.find(where) != std::string::npos;
  });
  if (found == means.end()) throw std::runtime_error("no mean of " + name + " " + where);
  return *found;
}

double half_of(const Interval& i) { return 0.5 * (i.high - i.low); }

// Three samples that differ by 6 %, far more than a record's noise of 0.2 %: the interval is Student's of three values, t(0.975,
// 2) s/sqrt(3) with s of what went in, to the noise, and holds the mean that went in. A single peak, which has no interval
// of its own, gets one by the scatter.
TEST(ProtocolReplicates, IntervalsHoldTheScatterBetweenTheRecords) {
  const std::vector<ReplicateMean> means =
      replicate_means(readings_of({sample(0.94, 1), sample(1.0, 2), sample(1.06, 3)}));
  const auto expect = [&](const ReplicateMean& m, double truth) {
    EXPECT_EQ(m.records, 3);
    ASSERT_TRUE(m.mean.ci95);
    EXPECT_NEAR(half_of(*m.mean.ci95), 4.3027 * 0.06 * truth / std::sqrt(3.0), 0.02 * truth)
        << m.parameter.name;
    EXPECT_NEAR(m.mean.value, truth, 0.01 * truth) << m.parameter.name;
    EXPECT_TRUE(m.mean.ci95->low < truth && truth < m.mean.ci95->high) << m.parameter.name;
  };
  expect(mean_named(means, "yield_stress"), 40.0);
  expect(mean_named(means, "structuration_rate_by_flow_curve"), 0.8);
  expect(mean_named(means, "static_yield_stress_by_flow_curve", "after 240"), 232.0);
  expect(mean_named(means, "static_yield_stress_by_flow_curve", "after 60"), 88.0);
  EXPECT_GT(mean_named(means, "static_yield_stress", "after 240").mean.value, 260.0);
}

// The same record three times scatters by nothing, and claims no more than once.
TEST(ProtocolReplicates, AreNeverSurerThanTheirParts) {
  const ProtocolReading one = readings_of({sample(1.0, 4)}).front();
  const std::vector<ReplicateMean> means = replicate_means(std::vector{one, one, one});
  int with_intervals = 0;
  for (const ReplicateMean& m : means) {
    const auto& part = m.of_record.front();
    if (!part || !part->ci95) continue;
    ++with_intervals;
    ASSERT_TRUE(m.mean.ci95) << m.parameter.name;
    EXPECT_GE(half_of(*m.mean.ci95), 0.999 * half_of(*part->ci95)) << m.parameter.name;
  }
  EXPECT_GE(with_intervals, 5);  // tau_0, mu, A_thix of peaks and by the flow curve, stress without rest
}

// The rate exponent may be negative, and its interval with it.
TEST(ProtocolReplicates, AnExponentsIntervalMayBeNegative) {
  std::vector<ProtocolReading> readings(2);
  for (ProtocolReading& r : readings)
    r.breakdown.exponent = ParameterEstimate{0.04, Interval{-0.27, 0.34}, false};
  const std::vector<ReplicateMean> means = replicate_means(readings);
  const ReplicateMean& m = mean_named(means, "rate_exponent");
  EXPECT_NEAR(m.mean.ci95->low, -0.27, 1e-12);
}

std::string file_of(const GapTest& test, int number) {
  const auto file = std::filesystem::temp_directory_path() / text_of("tremie_protocol_%d.csv", number);
  const ProtocolRecord r = record_of(test);
  std::string text = "time_s,speed_rad_per_s,torque_N_m\n";
  for (std::size_t i = 0; i < r.time.size(); ++i)
    text += text_of("%.6f,%.9g,%.9g\n", r.time[i], r.omega[i], r.torque[i]);
  std::ofstream(file) << text;
  return file.string();
}

// A flow index of 0.97 is told from 1 by this record alone; the others are Bingham's, and so is the material.
TEST(ProtocolReplicates, OneMaterialHasOneLaw) {
  FitOptions options;
  options.protocol = true;
  const std::vector<std::filesystem::path> data{TREMIE_REFERENCE_DATA};
  GapTest other = sample(1.0, 7, 0.97);
  std::vector<RecordSource> sources{{.name = file_of(sample(1.0, 5), 1)},
                                    {.name = file_of(other, 2)},
                                    {.name = file_of(sample(1.0, 6), 3)}};
  ASSERT_EQ(law_read(fit_records({sources[1]}, options, data).protocols.front().reading), "herschel_bulkley");
  const RecordFits fits = fit_records(sources, options, data);
  ASSERT_EQ(fits.protocols.size(), 3u);
  for (const ProtocolFit& p : fits.protocols) EXPECT_EQ(law_read(p.reading), "bingham");
  ASSERT_EQ(fits.notes.size(), 1u);
  EXPECT_NE(
      fits.notes.front().find("tremie_protocol_2.csv: alone its flow curve has the law herschel_bulkley"),
      std::string::npos);
  EXPECT_EQ(mean_named(fits.means, "yield_stress").records, 3);
  // one instrument: shear stresses do not go with torques
  const std::string stresses = (std::filesystem::temp_directory_path() / "tremie_protocol_4.csv").string();
  std::ofstream(stresses)
      << "time_s,shear_rate_1_per_s,shear_stress_Pa\n1,1,50\n2,2,60\n3,3,70\n4,4,80\n5,5,90\n";
  EXPECT_THROW(fit_records({sources[0], {.name = stresses}}, options, data), RecordError);
  // two of three by Herschel-Bulkley: the third takes it
  sources[0].name = file_of(sample(1.0, 8, 0.6), 1), sources[1].name = file_of(sample(1.0, 9, 0.6), 2);
  const RecordFits rich = fit_records(sources, options, data);
  for (const ProtocolFit& p : rich.protocols) EXPECT_EQ(law_read(p.reading), "herschel_bulkley");
  EXPECT_EQ(mean_named(rich.means, "flow_index").records, 3);
}

}  // namespace
}  // namespace tremie
