// The one call that the command and Python make, and the tables that it reads.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <set>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/tables/text.hpp"
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

// A torque is the stress over the constant, a speed the rate over the other: what goes in comes out, by every geometry.
FitResult fit_of_text(const std::string& text, const std::string& geometry, const std::string& law) {
  const auto file = std::filesystem::temp_directory_path() / "tremie_geometries.csv";
  std::ofstream(file) << text;
  FitOptions options = with("geometry", geometry);
  options.law = law;
  return fit_records({{.name = file.string()}}, options, data).fits.front();
}

TEST(Geometries, GiveBackTheMaterialThatWentIn) {
  constexpr double pi = std::numbers::pi, R = 0.025, gap = 1e-3, tau_0 = 20.0, mu = 2.5, k = 3.0, n = 0.5;
  const double speeds[] = {0.01, 0.05, 0.1, 0.3, 0.8, 2.0};
  const auto text_of_torques = [&](auto torque) {
    std::string text = "speed_rad_per_s,torque_N_m\n";
    for (const double w : speeds) text += text_of("%.17g,%.17g\n", w, torque(w));
    return text;
  };
  const double angle = pi / 180.0;
  const FitResult cone = fit_of_text(text_of_torques([&](double w) {
                                       return 2.0 * pi / 3.0 * R * R * R * (tau_0 + mu * w / std::tan(angle));
                                     }),
                                     "cone_plate, 25 mm, 1 deg", "bingham");
  EXPECT_NEAR(cone.tau_0->value, tau_0, 1e-3);
  EXPECT_NEAR(cone.mu->value, mu, 1e-4);
  // the integral of 2 pi r^2 tau(r) over the plate, Bingham and Herschel-Bulkley
  const FitResult plates = fit_of_text(text_of_torques([&](double w) {
                                         return 2.0 * pi * R * R * R * (tau_0 / 3.0 + mu * w * R / gap / 4.0);
                                       }),
                                       "parallel_plates, 25 mm, 1 mm", "bingham");
  EXPECT_NEAR(plates.tau_0->value, tau_0, 1e-3);
  EXPECT_NEAR(plates.mu->value, mu, 1e-4);
  const FitResult hb =
      fit_of_text(text_of_torques([&](double w) {
                    return 2.0 * pi * R * R * R * (tau_0 / 3.0 + k * std::pow(w * R / gap, n) / (n + 3.0));
                  }),
                  "parallel_plates, 25 mm, 1 mm", "herschel_bulkley");
  EXPECT_NEAR(hb.tau_0->value, tau_0, 1e-2);
  EXPECT_NEAR(hb.of_law.at("consistency")->value, k, 1e-2);
  EXPECT_NEAR(hb.of_law.at("flow_index")->value, n, 1e-3);
  const FitResult constants =
      fit_of_text(text_of_torques([&](double w) { return (tau_0 + mu * 5.0 * w) / 2e4; }),
                  "constants, 2e4, 5", "bingham");
  EXPECT_NEAR(constants.tau_0->value, tau_0, 1e-3);
  EXPECT_NEAR(constants.mu->value, mu, 1e-4);
  // a Newtonian fluid in both gaps of a double gap, by the closed form of each
  const auto inverse = [](double r) { return 1.0 / (r * r); };
  const double both =
      4.0 * pi * 0.042 *
      (1.0 / (inverse(0.01191) - inverse(0.01233)) + 1.0 / (inverse(0.01333) - inverse(0.0138)));
  const FitResult double_gap =
      fit_of_text(text_of_torques([&](double w) { return both * mu * w; }),
                  "double_gap, 11.91 mm, 12.33 mm, 13.33 mm, 13.8 mm, 42 mm", "bingham");
  EXPECT_NEAR(double_gap.mu->value, mu, 1e-3);
  EXPECT_NEAR(double_gap.tau_0->value, 0.0, 1e-3);
}

TEST(Geometries, FannsDialAndATableOfNames) {
  // six readings of a spacer fluid; 0.511 Pa on the bob by degree
  const FitResult f = fit_of_text("RPM,Dial reading\n600,60\n300,45.5\n200,37.5\n100,29\n6,14\n3,12\n",
                                  "fann_r1b1", "herschel_bulkley");
  EXPECT_NEAR(f.tau_0->value, 4.25, 0.05);
  EXPECT_NEAR(f.of_law.at("flow_index")->value, 0.514, 0.005);
  EXPECT_THROW(fit_of_text("RPM,torque_N_m\n1,2\n", "fann", "bingham"), std::invalid_argument);
  EXPECT_THROW(fit_of_text("RPM,torque_N_m\n1,2\n", "cone_plate, 25, 1 deg", "bingham"),
               std::invalid_argument);
}

// A decay and a flow curve of one material in one record: read alone as among its sections, by the flow curve's values.
TEST(FitRecords, ASectionIsReadAloneAsAmongTheOthers) {
  const auto file = std::filesystem::temp_directory_path() / "tremie_sections.csv";
  std::string text = "time_s,speed_rpm,torque_N_m\n";
  const Bingham material{54.0, 35.8};
  const auto add = [&](double t, double rpm, double more) {
    text += text_of("%.4f,%.4f,%.8g\n", t, rpm,
                    (1.0 + more) * reiner_riwlin(material, angular_speed(rpm / 60.0)).torque);
  };
  for (int i = 0; i < 80; ++i) add(0.5 * i, 15.0, std::exp(-0.25 * i) + 1e-3 * std::sin(7.0 * i));
  for (int i = 0; i <= 50; ++i) add(40.0 + 0.5 * i, 2.0 + 0.5 * i, 1e-3 * std::sin(5.0 * i));
  for (int i = 1; i <= 50; ++i) add(65.0 + 0.5 * i, 27.0 - 0.5 * i, 1e-3 * std::sin(5.0 * i) - 0.05);
  std::ofstream(file) << text;
  const RecordFits alone = fit_records({{.name = file.string()}}, {}, data);
  const RecordFits all = fit_records({{.name = file.string()}}, with("protocol", true), data);
  const SectionReading& decay = all.protocols.front().reading.sections.front();
  ASSERT_EQ(decay.section.kind, SectionKind::constant_rate);
  ASSERT_TRUE(decay.fit);
  EXPECT_TRUE(alone.fits.front().tau_0->given);
  EXPECT_DOUBLE_EQ(alone.fits.front().tau_0->value, decay.fit->tau_0->value);
  EXPECT_DOUBLE_EQ(alone.fits.front().scatter, decay.fit->scatter);
  // the branch down lies 5 % below the one up: the loop is that share of the integral
  double area = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double rpm = 2.0 + 25.0 * (i + 0.5) / 1000.0;
    area += 0.05 * reiner_riwlin(material, angular_speed(rpm / 60.0)).torque * angular_speed(25.0 / 60.0) /
            1000.0;
  }
  ASSERT_TRUE(all.protocols.front().reading.sections.back().loop_area);
  EXPECT_NEAR(*all.protocols.front().reading.sections.back().loop_area, area, 0.03 * area);
}

}  // namespace
}  // namespace tremie
