// The one call that the command and Python make, and the tables that it reads.

#include <gtest/gtest.h>

#include <set>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/vane/vane_blades.hpp"
#include "rheometer/vane/vane_ends.hpp"
#include "rheometer/whole_fit/fit_record.hpp"
#include "tests/rheometer/synthetic_record.hpp"

namespace tremie {
namespace {

const std::vector<std::filesystem::path> data{TREMIE_REFERENCE_DATA};

FitOptions with(const std::string& name, const auto& value, FitOptions options = {}) {
  for (const FitOption& option : fit_options())
    if (option.name == name) set_option(options, option, value);
  return options;
}

TEST(FitOptions, NamesAndKeysOfTheInputAreUnique) {
  std::set<std::string> names, keys;
  std::set<int> places;
  std::size_t in_the_input = 0;
  for (const FitOption& option : fit_options()) {
    names.insert(option.name);
    if (option.input.place == 0) continue;
    keys.insert(option.input.key), places.insert(option.input.place), ++in_the_input;
  }
  EXPECT_EQ(names.size(), fit_options().size());
  EXPECT_EQ(keys.size(), in_the_input);
  EXPECT_EQ(places.size(), in_the_input);
}

TEST(FitOptions, AValueOutsideOfItsRangeIsRefused) {
  EXPECT_THROW(with("vane_radius", -0.1), std::invalid_argument);
  EXPECT_THROW(with("instrument_compliance", -0.1), std::invalid_argument);
  EXPECT_DOUBLE_EQ(with("torque_offset", -0.1).torque_offset, -0.1);
  EXPECT_THROW(with("law", std::string("none")), std::invalid_argument);
  EXPECT_THROW(with("speed", true), std::invalid_argument);
  EXPECT_THROW(with("protocol", 1.0), std::invalid_argument);
}

// The words of the option are those of the registry; a parameter is one row, whichever law it is of.
TEST(FlowLaws, AreTheWordsOfTheOptionAndParametersOfTheirOwn) {
  std::set<std::string> keys;
  for (const FitParameter& p : fit_parameters()) keys.insert(p.key);
  EXPECT_EQ(keys.size(), fit_parameters().size());
  for (const FlowLaw& law : flow_laws()) {
    EXPECT_EQ(with("law", law.name).law, law.name);
    EXPECT_EQ(law.parameters.front().row.name, "yield_stress");
    for (const LawParameter& p : law.parameters) EXPECT_TRUE(keys.contains(p.row.key)) << p.row.key;
  }
  EXPECT_THROW(flow_law("none"), std::invalid_argument);
}

// Torques a little above and below each parameter, against the law's own slope.
TEST(FlowLaws, SlopesAreTheTorquesDerivatives) {
  constexpr double omega = 2.0;
  for (const FlowLaw& law : flow_laws()) {
    const std::vector<double> at = law.start({54.0, 35.8});
    const FlowTorque torque = law.torque(at, omega, {});
    for (std::size_t k = 0; k < at.size(); ++k) {
      std::vector<double> above = at, below = at;
      const double step = 1e-4 * at[k];
      above[k] += step, below[k] -= step;
      const double slope =
          (law.torque(above, omega, {}).torque - law.torque(below, omega, {}).torque) / (2.0 * step);
      EXPECT_NEAR(torque.slope[k] / slope, 1.0, 1e-4) << law.name << k;
    }
  }
}

// Torques that blades and both ends of an ICAR's vane have at each speed, for 80 Pa and 30 Pa s.
TEST(FitRecords, ARecordInMemoryIsCorrectedForEndsAndBlades) {
  const Bingham mix{80.0, 30.0};
  const std::string folder = TREMIE_REFERENCE_DATA;
  const std::string ends = read_text_file(folder + "/vane_ends/table.csv");
  const BladeTable blades = blade_table(read_text_file(folder + "/vane_blades/table.csv"), "blades");
  TorqueRecord record = synthetic::flow_curve(8, 0.0);
  for (std::size_t i = 0; i < record.omega.size(); ++i) {
    const double Bi = mix.tau_0 / (mix.mu * record.omega[i]);
    record.torque[i] = reiner_riwlin(mix, record.omega[i]).torque * blade_factor(blades, {}, Bi) *
                       end_factor_from_table(ends, "ends", {}, Bi);
  }
  FitOptions options;
  options.ends = options.blades = "computed";
  const RecordFits all = fit_records({{.name = "", .record = record}}, options, data);
  ASSERT_EQ(all.fits.size(), 1u);
  EXPECT_NEAR(all.fits[0].tau_0->value, mix.tau_0, 0.02 * mix.tau_0);
  EXPECT_NEAR(all.fits[0].mu->value, mix.mu, 0.02 * mix.mu);
  EXPECT_GT(all.end_factor, 1.2);
  ASSERT_EQ(all.moves.size(), 2u);
  EXPECT_EQ(all.moves[0].key, "yield_stress_Pa");
  EXPECT_LT(all.moves[0].change, -0.1);
}

TEST(FitRecords, TheTorquesOffsetIsTakenOffARecordInMemory) {
  TorqueRecord record = synthetic::flow_curve(8, 0.0);
  for (double& torque : record.torque) torque += 0.5;
  const RecordFits all = fit_records({{.name = "", .record = record}}, with("torque_offset", 0.5), data);
  EXPECT_NEAR(all.fits[0].tau_0->value, 54.0, 1e-3);
}

TEST(FitRecords, ATableThatIsNotThereIsToldWithItsFolder) {
  try {
    fit_records({{.name = "", .record = synthetic::flow_curve(8, 0.0)}},
                with("ends", std::string("computed")), {});
    FAIL();
  } catch (const RecordError& error) {
    EXPECT_NE(std::string(error.what()).find("reference_data/vane_ends"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tremie
