// Sections of a protocol by the torques of the cylinder that four blades span: closed loops over made records
// (made_gap.hpp), of which each torque is multiplied by what the table of finite elements says of its Bingham number.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "rheometer/protocol/protocol.hpp"
#include "rheometer/records/torque_record.hpp"
#include "rheometer/tables/text.hpp"
#include "rheometer/whole_fit/fit_record.hpp"
#include "tests/rheometer/made_gap.hpp"

namespace tremie {
namespace {

using made::GapMaterial, made::GapTest;

const Instrument instrument{.vane_radius = 0.06, .vane_height = 0.12, .container_radius = 0.12};
const std::string table_text = read_text_file(TREMIE_REFERENCE_DATA "/vane_blades/table.csv");

/// Rows of the table for a container of 2 radii, linear in ln(1 + Bi), the last factor beyond.
double factor_of(double Bi) {
  std::istringstream lines(table_text);
  double before_x = 0.0, before = 0.0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("2,")) continue;
    const auto comma = line.find(',', 2);
    const double x = std::log1p(std::stod(line.substr(2, comma - 2))),
                 factor = std::stod(line.substr(comma + 1));
    const double at = std::log1p(Bi);
    if (x > at && before > 0.0) return before + (factor - before) * (at - before_x) / (x - before_x);
    before_x = x, before = factor;
  }
  return before;
}

/// The Bingham number of a cylinder's torque, by Reiner and Riwlin:
/// mu Omega = T/(4 pi h) (1/R_i^2 - 1/R_s^2) - tau_y ln(R_s/R_i), R_s the edge of the plug or the container.
double bingham_number(double mu, double omega, double torque) {
  const double h = instrument.vane_height, R = instrument.vane_radius;
  const auto speed = [&](double tau_y) {
    const double R_s =
        std::min(instrument.container_radius, std::sqrt(torque / (2.0 * std::numbers::pi * h * tau_y)));
    return (torque / (4.0 * std::numbers::pi * h) * (1.0 / (R * R) - 1.0 / (R_s * R_s)) -
            tau_y * std::log(R_s / R)) /
           mu;
  };
  double low = 1e-9, high = torque / (2.0 * std::numbers::pi * h * R * R);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (speed(middle) > omega ? low : high) = middle;
  }
  return low / (mu * omega);
}

GapTest test_of_blades() {
  GapTest test;
  test.instrument = instrument, test.elastic_factor = factor_of(0.0);
  test.material.n = 1.0;
  const double mu = test.material.k;
  test.factor = [mu](double omega, double torque) { return factor_of(bingham_number(mu, omega, torque)); };
  return test;
}

FitInput by_roussel() {
  FitInput in;
  in.instrument = instrument;
  in.kinetics = RousselKinetics{};
  return in;
}

ProtocolOptions with_blades() { return {.compliance = 0.0, .blades = blade_table(table_text, "table.csv")}; }

const SectionReading& section_of(const ProtocolReading& r, SectionKind kind) {
  return *std::find_if(r.sections.begin(), r.sections.end(),
                       [&](const SectionReading& s) { return s.section.kind == kind; });
}

long reasons_with(const ProtocolReading& r, const std::string& words) {
  return std::count_if(r.reasons.begin(), r.reasons.end(),
                       [&](const std::string& why) { return why.find(words) != std::string::npos; });
}

// 0.2 % of noise: 1 % of yield stress, viscosity and lambda, 2 % of single peaks and of the modulus. Read as a cylinder the
// same record has a viscosity more than a quarter too small.
TEST(ProtocolBlades, EverySectionGivesTheMaterialBack) {
  const GapTest test = test_of_blades();
  const GapMaterial& m = test.material;
  const ProtocolRecord record = record_of(test);
  const ProtocolReading r = read_protocol(record, by_roussel(), with_blades());
  EXPECT_TRUE(r.reasons.empty());
  const SectionReading& curve = section_of(r, SectionKind::flow_curve_down);
  ASSERT_TRUE(curve.fit && curve.fit->tau_0 && curve.fit->mu);
  EXPECT_NEAR(curve.fit->tau_0->value, m.tau_0, 0.01 * m.tau_0);
  EXPECT_NEAR(curve.fit->mu->value, m.k, 0.01 * m.k);
  const SectionReading& decay = section_of(r, SectionKind::constant_rate);
  ASSERT_TRUE(decay.fit && decay.fit->lambda_0 && decay.fit->alpha);
  EXPECT_NEAR(decay.fit->lambda_0->value, m.A_thix * 240.0 / m.tau_0, 0.02 * m.A_thix * 240.0 / m.tau_0);
  EXPECT_NEAR(decay.fit->alpha->value, m.alpha, 0.03 * m.alpha);
  for (const SectionReading& s : r.sections) {
    if (!s.start_up) continue;
    const double truth = m.tau_0 + m.A_thix * s.section.rest_before;
    ASSERT_TRUE(s.start_up->static_by_law && s.start_up->shear_modulus);
    EXPECT_NEAR(*s.start_up->static_by_law / truth, 1.0, 0.02);
    EXPECT_NEAR(*s.start_up->shear_modulus, m.G, 0.02 * m.G);
  }
  EXPECT_NEAR(r.structuration.A_thix_by_law->value, m.A_thix, 0.02 * m.A_thix);
  FitInput as_bingham = by_roussel();
  as_bingham.law = "bingham", as_bingham.law_given = true;
  const ProtocolReading plain = read_protocol(record, as_bingham);
  const auto& as_cylinder = section_of(plain, SectionKind::flow_curve_down).fit;
  ASSERT_TRUE(as_cylinder && as_cylinder->mu);
  EXPECT_LT(as_cylinder->mu->value, 0.75 * m.k);
}

TEST(ProtocolBlades, ASectionThatCannotBeCorrectedSaysSo) {
  GapTest test = test_of_blades();
  test.flow_curve = false;
  const ProtocolRecord record = record_of(test);
  const ProtocolReading none = read_protocol(record, by_roussel(), with_blades());
  EXPECT_EQ(reasons_with(none, "--blades computed"), 4);
  EXPECT_FALSE(section_of(none, SectionKind::constant_rate).fit);
  EXPECT_FALSE(none.structuration.A_thix);
  FitInput given = by_roussel();
  given.tau_0 = test.material.tau_0, given.mu = test.material.k;
  const ProtocolReading r = read_protocol(record, given, with_blades());
  EXPECT_TRUE(r.reasons.empty());
  EXPECT_NEAR(r.structuration.A_thix_by_law->value, test.material.A_thix, 0.02 * test.material.A_thix);
}

// Herschel-Bulkley with n = 0.4, which Bingham misses by more than its table could hide.
TEST(ProtocolBlades, AnotherLawThanBinghamsIsRefused) {
  GapTest test;
  test.instrument = instrument, test.material.n = 0.4, test.material.k = 60.0;
  const ProtocolReading r = read_protocol(record_of(test), by_roussel(), with_blades());
  EXPECT_FALSE(section_of(r, SectionKind::flow_curve_down).fit);
  EXPECT_EQ(reasons_with(r, "those of a Bingham material, which this flow curve is not"), 1);
}

// The call of the command and of Python, with the table of the data folder; and what it refuses.
TEST(ProtocolBlades, ThroughTheFitOfRecords) {
  const auto file = std::filesystem::temp_directory_path() / "tremie_protocol_blades.csv";
  GapTest test = test_of_blades();
  test.growth_rests = {};
  const ProtocolRecord record = record_of(test);
  std::string text = "time_s,speed_rad_per_s,torque_N_m\n",
              even = "time_s,shear_rate_1_per_s,shear_stress_Pa\n";
  for (std::size_t i = 0; i < record.time.size(); ++i) {
    text += text_of("%.6f,%.9g,%.9g\n", record.time[i], record.omega[i], record.torque[i]);
    even += text_of("%.6f,%.9g,%.9g\n", record.time[i], 3.0 * record.omega[i], 300.0 * record.torque[i]);
  }
  std::ofstream(file) << text;
  FitOptions options;
  options.vane_radius = 0.06, options.vane_height = 0.12, options.container_radius = 0.12;
  options.protocol = true, options.blades = "computed", options.kinetics = "roussel";
  const std::vector<std::filesystem::path> data{TREMIE_REFERENCE_DATA};
  const RecordFits fits = fit_records({{.name = file.string()}}, options, data);
  EXPECT_EQ(fits.options.law, "bingham");
  EXPECT_NEAR(section_of(fits.protocols.front().reading, SectionKind::flow_curve_down).fit->mu->value,
              test.material.k, 0.01 * test.material.k);
  options.protocol = false;  // the decay alone, by the flow curve of the same file
  const RecordFits alone = fit_records({{.name = file.string()}}, options, data);
  EXPECT_NEAR(alone.fits.front().lambda_0->value, 4.8, 0.02 * 4.8);
  options.protocol = true, options.law = "auto";
  EXPECT_THROW(fit_records({{.name = file.string()}}, options, data), std::invalid_argument);
  std::ofstream(file) << even;
  options.law.clear();
  EXPECT_THROW(fit_records({{.name = file.string()}}, options, data), RecordError);
}

}  // namespace
}  // namespace tremie
