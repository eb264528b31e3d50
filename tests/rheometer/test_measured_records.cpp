// What fits say of measured records, and of records that no model describes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "rheometer/protocol/protocol.hpp"
#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"
#include "rheometer/regression/lack_of_fit.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/vane/fit_with_blades.hpp"
#include "rheometer/vane/vane_ends.hpp"
#include "rheometer/whole_fit/replicates.hpp"
#include "tests/rheometer/synthetic_record.hpp"

namespace tremie {
namespace {

using namespace synthetic;

bool inside(const std::optional<ParameterEstimate>& e, double truth) {
  return e && e->ci95 && e->ci95->low <= truth && truth <= e->ci95->high;
}

FitInput automatic() {
  FitInput in;
  in.omega = omega;
  in.rest = rest;
  in.choose_kinetics = true;
  return in;
}

// The rests and peaks of the measured record as they stand in the file: 12.1, 39.9, 82.8, 148.7 and 220.6 mN m after 30
// to 480 s; the first start-up, 4.0 mN m, ends before its peak. Half of the torque is gone within 1.5 s of the first peak;
// a power of time describes that decay within 2 %, an exponential within 10 % does not.
TEST(MeasuredRecord, ThePasteIsReadSectionBySection) {
  const std::string file = TREMIE_REFERENCE_DATA "/rheocem/SYS_0.55_250_1.csv";
  FitInput in;
  in.instrument = {0.02, 0.06, 0.05};
  in.choose_kinetics = true;
  const ProtocolReading r = read_protocol(parse_protocol_record(read_text_file(file), file), in);
  const double peak[] = {4.0, 12.1, 39.9, 82.8, 148.7, 220.6}, before[] = {30, 30, 60, 120, 240, 480};
  std::size_t found = 0;
  for (const SectionReading& s : r.sections) {
    if (!s.start_up) continue;
    ASSERT_LT(found, 6u);
    EXPECT_NEAR(1e3 * s.start_up->peak_torque, peak[found], 0.06);
    EXPECT_NEAR(s.section.rest_before, before[found], 0.6);
    EXPECT_EQ(s.start_up->peak_inside, found > 0);
    // beyond 1000 s the export rounds its times to 1 s, ten rows to each: no rise over the angle
    EXPECT_EQ(s.start_up->shear_modulus.has_value(), found > 0 && found < 5);
    ++found;
  }
  EXPECT_EQ(found, 6u);
  ASSERT_TRUE(r.sections.front().decay);
  const DecayShape& d = *r.sections.front().decay;
  EXPECT_NEAR(1e3 * d.peak_torque, 227.2, 0.1);
  EXPECT_LT(*d.half_time, 1.5);
  EXPECT_LT(*d.power_scatter, 0.02);
  EXPECT_GT(*d.exponential_scatter, 0.05);
  // none of the kinetics describes that decay in the gap, and the outcome says so
  EXPECT_EQ(r.sections.front().fit->model, "power");
  EXPECT_FALSE(r.reasons.empty());
  EXPECT_FALSE(r.sections.front().fit->alpha.has_value());
  EXPECT_EQ(r.structuration.rest.size(), 5u);
  EXPECT_GT(*r.structuration.early, *r.structuration.late);
  // Peaks saturate: the one after 480 s, 1463 Pa, within 307 Pa by the shorter rests.
  ASSERT_TRUE(r.structuration.saturation && r.structuration.saturation->forecast_of_longest);
  EXPECT_NEAR(*r.structuration.saturation->forecast_of_longest, 1463.0, 307.0);
  EXPECT_LT(r.structuration.saturation->chance, 0.01);
  // The peaks after 240 and 480 s by the shorter rests, within the scatter that the source's other records have.
  ASSERT_EQ(r.structuration.forecasts.size(), 2u);
  EXPECT_NEAR(r.structuration.forecasts[0].forecast, r.structuration.forecasts[0].measured, 207.0);
  EXPECT_NEAR(r.structuration.forecasts[1].forecast, r.structuration.forecasts[1].measured, 307.0);
  // Speeds differ by 346, half times by some 1.6: far from a = 1, breakdown by strain. One set of modes describes the
  // decay at 40 rpm within 2 %; k and a give every half time within a fifth, as far as the start-ups differ among them.
  ASSERT_TRUE(r.breakdown.exponent && r.breakdown.exponent->ci95);
  EXPECT_LT(r.breakdown.exponent->ci95->high, 0.5);
  EXPECT_LT(r.breakdown.exponent->ci95->low, 0.1);
  EXPECT_GE(r.breakdown.modes.size(), 2u);
  EXPECT_LT(*r.breakdown.times.front().scatter, 0.02);
  for (const BreakdownTime& t : r.breakdown.times)
    EXPECT_NEAR(t.half_time_by_law.value_or(t.half_time), t.half_time, 0.2 * t.half_time) << t.section;
  ASSERT_GE(r.breakdown.candidates.size(), 4u);
  EXPECT_EQ(r.breakdown.candidates.front().name, "roussel");
  EXPECT_GT(*r.breakdown.candidates.front().difference, 50.0);
  EXPECT_TRUE(r.breakdown.candidates.back().chosen);
}

TEST(MeasuredRecord, StepsRampsAndAClockThatStartsAgain) {
  std::string text = "time_s,speed_rpm,torque_N_m\n";
  const auto add = [&](double t, double rpm) {
    text += std::to_string(t) + ',' + std::to_string(rpm) + ',' +
            std::to_string(rpm > 0.0 ? reiner_riwlin(mix_a, angular_speed(rpm / 60.0)).torque : 0.0) + '\n';
  };
  for (int i = 0; i < 60; ++i) add(0.5 * i, 30.0);
  for (int i = 0; i < 40; ++i) add(0.5 * i, 0.0);
  for (int step = 0; step < 6; ++step)
    for (int i = 0; i < 10; ++i) add(0.5 * i, 30.0 - 5.0 * step);
  for (int i = 0; i <= 50; ++i) add(0.5 * i, 2.0 + 0.5 * i);
  const ProtocolRecord record = parse_protocol_record(text, "made.csv");
  EXPECT_EQ(record.restarts.size(), 8u);
  const std::vector<Section> s = find_sections(record);
  ASSERT_EQ(s.size(), 4u);
  EXPECT_TRUE(s[0].kind == SectionKind::constant_rate && s[0].pre_shear);
  EXPECT_EQ(s[1].kind, SectionKind::rest);
  EXPECT_TRUE(s[2].kind == SectionKind::flow_curve_down && s[2].stepped);
  EXPECT_EQ(s[3].kind, SectionKind::flow_curve_up);
  const ProtocolReading reading = read_protocol(record, {});
  EXPECT_NEAR(reading.sections[2].fit->tau_0->value, 54.0, 0.1);
  EXPECT_NEAR(reading.sections[3].fit->mu->value, 35.8, 0.1);
}

// The fit's own integral against the one that serves every law, with and without a plug; the derivatives against central
// differences.
TEST(HerschelBulkleyTorque, IsTheCouetteIntegralWithItsDerivatives) {
  const Instrument in;
  for (const double n : {0.4, 1.0, 1.6})
    for (const double tau_0 : {0.0, 20.0, 200.0})
      for (const double w : {0.02, 3.0}) {
        const HerschelBulkleyFluid f{tau_0, 30.0, n};
        const HerschelBulkleyTorque t = herschel_bulkley_torque(f, w, in);
        const double expected = n == 1.0 ? reiner_riwlin({tau_0, 30.0}, w, in).torque
                                         : couette_torque(HerschelBulkley{30.0, n}, tau_0, 0.0, w, in);
        EXPECT_NEAR(t.torque / expected, 1.0, 1e-6);
        const auto moved = [&](double k, double m) {
          return herschel_bulkley_torque({tau_0, k, m}, w, in).torque;
        };
        EXPECT_NEAR(t.d_k * 30.0, (moved(30.003, n) - moved(29.997, n)) / 2e-4, 1e-4 * t.torque);
        EXPECT_NEAR(t.d_n, (moved(30.0, n + 1e-4) - moved(30.0, n - 1e-4)) / 2e-4, 1e-4 * t.torque);
      }
}

TEST(FitFlowCurve, TellsHerschelBulkleyFromBingham) {
  FitInput in;
  in.law = "auto";
  TorqueRecord record = flow_curve(30);
  for (std::size_t i = 0; i < record.omega.size(); ++i)
    record.torque[i] = herschel_bulkley_torque({40.0, 60.0, 0.5}, record.omega[i], {}).torque;
  record.line.clear();
  finish(record, 0.005, 4);
  const FitResult f = fit(record, in);
  EXPECT_EQ(f.model, "herschel_bulkley");
  EXPECT_TRUE(inside(f.of_law.at("flow_index"), 0.5));
  EXPECT_TRUE(inside(f.tau_0, 40.0));
  EXPECT_EQ(fit(flow_curve(30, 0.005, 4), in).model, "bingham");
}

// Between 0.025 and 0.7 rev/s a Bingham line misses Herschel-Bulkley's torque with n = 0.6 by 2 %, too little to be refused, and
// has 78 Pa for its 60: the fit says on which law that hangs. A Bingham record of the same scatter has no such note.
TEST(FitFlowCurve, ABinghamYieldStressThatHangsOnTheLawIsTold) {
  TorqueRecord record = flow_curve(12);
  for (std::size_t i = 0; i < record.omega.size(); ++i) {
    record.omega[i] = 0.157 * std::pow(1.35, static_cast<double>(i));
    record.torque[i] = herschel_bulkley_torque({60.0, 25.0, 0.6}, record.omega[i], {}).torque;
  }
  record.line.clear();
  finish(record, 0.004, 4);
  const auto hangs_on_law = [](const FitResult& f) {
    const bool told = std::any_of(f.notes.begin(), f.notes.end(), [](const std::string& note) {
      return note.find("--law herschel_bulkley") != std::string::npos;
    });
    EXPECT_EQ(f.law_in_doubt, told);
    return told;
  };
  EXPECT_TRUE(hangs_on_law(fit(record, {})));
  EXPECT_FALSE(hangs_on_law(fit(flow_curve(12, 0.004, 4), {})));
}

// Records that no model describes: a jump, a rise, a saw tooth, a level torque, a torque that falls with the speed.
TEST(Fit, GivesNoNumberThatARecordDoesNotHold) {
  const auto decay = [](auto torque) {
    TorqueRecord record;
    record.kind = RecordKind::torque_decay;
    record.time = even_times(201, 20.0);
    for (const double t : record.time) record.torque.push_back(torque(t));
    finish(record, 0.01, 3);
    return record;
  };
  TorqueRecord falling = flow_curve(10);
  for (std::size_t i = 0; i < 10; ++i) falling.torque[i] = 4.0 - 0.1 * static_cast<double>(i);
  falling.line.clear();
  finish(falling, 0.02, 5);
  FitInput in = automatic();
  in.choose_kinetics = false;
  for (const TorqueRecord& record :
       {decay([](double t) { return t < 10.0 ? 8.0 : 4.0; }), decay([](double t) { return 2.0 + 0.1 * t; }),
        decay([](double t) { return 3.0 + std::fmod(t / 4.0, 1.0); }), decay([](double) { return 2.0; }),
        falling}) {
    const FitResult f = fit(record, in);
    EXPECT_FALSE(f.reasons.empty());
    for (const auto* e : {&f.tau_0, &f.mu, &f.static_yield_stress, &f.lambda_0, &f.alpha, &f.A_thix})
      EXPECT_FALSE(e->has_value());
  }
}

// A power law's decay is told from an exponential one, and a speed that is given to fewer digits (0.005 %) moves no value
// by more than a tenth of its interval.
TEST(FitTorqueDecay, ChoosesTheKineticsAndIsNotMovedByTheLastDigitOfTheSpeed) {
  CouetteFlow flow{mix_a, {0.0, PowerKinetics{2e-4, 0.0, 3.0}, 8.0}, omega, {}};
  const std::vector<double> times = even_times(150, 30.0);
  TorqueRecord record;
  record.kind = RecordKind::torque_decay;
  record.time = times;
  record.torque = thixotropic_couette(flow, times).torque;
  finish(record, 0.01, 6);
  FitInput in = automatic();
  in.rest.reset();
  in.mu = 35.8;
  const FitResult f = fit(record, in);
  EXPECT_EQ(f.model, "power");
  EXPECT_TRUE(f.reasons.empty());
  EXPECT_TRUE(inside(f.static_yield_stress, 9.0 * 54.0));
  *in.omega *= 1.00005;
  const FitResult moved = fit(record, in);
  const std::pair<const std::optional<ParameterEstimate>*, const std::optional<ParameterEstimate>*> pairs[] =
      {{&f.tau_0, &moved.tau_0},
       {&f.static_yield_stress, &moved.static_yield_stress},
       {&f.lambda_0, &moved.lambda_0},
       {&f.alpha, &moved.alpha},
       {&f.exponent, &moved.exponent}};
  for (const auto& [a, b] : pairs) {
    ASSERT_EQ(a->has_value(), b->has_value());
    if (!*a) continue;
    EXPECT_LT(std::abs((*a)->value - (*b)->value), 0.1 * ((*a)->ci95->high - (*a)->ci95->low));
  }
}

// The default kinetics of a scene break structure down by k gamma_dot^a with a = 0.1: at one speed an exponential, which
// kinetics by strain miss. At 0.25 rev/s the rate in the sheared layer lies between 1 and 10 1/s, k gamma_dot^a between
// 0.334 and 0.42 1/s.
TEST(FitTorqueDecay, ReadsTheRateOfBreakdownByTime) {
  RatePowerKinetics by_time;
  by_time.breakdown = 0.334, by_time.rate_exponent = 0.1;
  const CouetteFlow flow{mix_a, {1.3, by_time, lambda_0}, omega, {}};
  TorqueRecord record;
  record.kind = RecordKind::torque_decay;
  record.time = even_times(150, 20.0);
  record.torque = thixotropic_couette(flow, record.time).torque;
  finish(record, 0.005, 7);
  FitInput in = automatic();
  in.tau_0 = 54.0, in.mu = 35.8;
  const FitResult f = fit(record, in);
  EXPECT_EQ(f.model, "rate_power");
  EXPECT_TRUE(f.reasons.empty());
  EXPECT_FALSE(f.alpha.has_value());
  ASSERT_TRUE(f.breakdown_rate.has_value());
  EXPECT_GT(f.breakdown_rate->value, 0.33);
  EXPECT_LT(f.breakdown_rate->value, 0.43);
  EXPECT_TRUE(inside(f.static_yield_stress, 366.0));
}

TEST(VaneEnds, TheTextbookAndATable) {
  EXPECT_NEAR(textbook_end_factor({}), 1.0 + 2.0 * 0.0635 / (3.0 * 0.127), 1e-12);
  const std::string table =
      "height_over_radius,container_over_radius,bingham_number,end_factor\n"
      "1,2,0,1.6\n1,3,0,1.5\n3,2,0,1.2\n3,3,0,1.1\n1,2,3,1.8\n1,3,3,1.7\n3,2,3,1.4\n3,3,3,1.3\n";
  EXPECT_NEAR(end_factor_from_table(table, "t.csv", {1.0, 2.0, 2.5}, 0.0), 1.25,
              1e-9);  // 1/2 between 1 and 1/3
  EXPECT_NEAR(end_factor_from_table(table, "t.csv", {1.0, 2.0, 2.5}, 1.0), 1.35, 1e-9);  // ln 2 of ln 4
  EXPECT_THROW(end_factor_from_table(table, "t.csv", {1.0, 4.0, 2.5}, 1.0), std::invalid_argument);
  EXPECT_EQ(end_factor_from_table(table, "t.csv", {1.0, 2.0, 2.5}, 4.0),
            end_factor_from_table(table, "t.csv", {1.0, 2.0, 2.5}, 3.0));  // where the table ends
  EXPECT_THROW(end_factor_from_table("1;2;3;4\n", "t.csv", {1.0, 2.0, 2.5}, 0.0), std::invalid_argument);
}

// Linear in ln(1 + Bi) and in the container; beyond the last Bingham number as at the last.
TEST(VaneBlades, TheTable) {
  const BladeTable table = blade_table(
      "# comment\ncontainer_over_radius,bingham_number,blade_factor\n2,0,0.6\n2,3,0.8\n3,0,0.7\n3,3,0.9\n",
      "t.csv");
  EXPECT_NEAR(blade_factor(table, {1.0, 2.0, 2.5}, 1.0), 0.75, 1e-12);
  EXPECT_NEAR(blade_factor(table, {1.0, 2.0, 2.0}, 50.0), 0.8, 1e-12);
  EXPECT_THROW(blade_factor(table, {1.0, 2.0, 4.0}, 1.0), std::invalid_argument);
  EXPECT_THROW(blade_table("2;0;0.6\n", "t.csv"), std::invalid_argument);
  EXPECT_THROW(blade_table("container_over_radius,bingham_number,blade_factor\n", "t.csv"),
               std::invalid_argument);
}

// A cylinder's torque by Reiner and Riwlin times the factor goes back to the cylinder's, from a Newtonian fluid to a
// Bingham number far beyond the table; to the bisection's last digits.
TEST(VaneBlades, TheCylindersTorqueComesBack) {
  const BladeTable table = blade_table("2,0,0.72\n2,1,0.79\n2,40,0.9\n3,0,0.74\n3,40,0.9\n", "t.csv");
  const Instrument in;
  for (const double tau_0 : {0.0, 1.0, 54.0, 366.0, 5000.0}) {
    const double torque = reiner_riwlin({.tau_0 = tau_0, .mu = 35.8}, 1.57, in).torque;
    const double vane = torque * blade_factor(table, in, tau_0 / (35.8 * 1.57));
    EXPECT_NEAR(torque_of_cylinder(table, in, 35.8, 1.57, vane), torque, 1e-9 * torque) << tau_0;
  }
}

// Torques of the ICAR's blades in the plane section of material points (tests/verification/vane_study.md, Mix A: 54 Pa,
// 35.8 Pa s), by the table of finite elements. 2 %: the two agree within 0.4 %, which the yield stress sees doubled.
TEST(VaneBlades, AFlowCurveOfBladesGivesTheMixBack) {
  TorqueRecord record;
  for (const double n : {0.5, 0.425, 0.35, 0.275, 0.2, 0.125, 0.05}) record.omega.push_back(angular_speed(n));
  record.torque = {0.9693, 0.8702, 0.7705, 0.6690, 0.5633, 0.4504, 0.3211};
  record.line = {2, 3, 4, 5, 6, 7, 8};
  const BladeTable table =
      blade_table(read_text_file(TREMIE_REFERENCE_DATA "/vane_blades/table.csv"), "table.csv");
  const VaneFit vane = fit_with_blades(record, {}, table);
  EXPECT_NEAR(vane.fit.tau_0->value, 54.0, 0.02 * 54.0);
  EXPECT_NEAR(vane.fit.mu->value, 35.8, 0.02 * 35.8);
  EXPECT_GT(vane.most_factor, vane.least_factor + 0.05);
  FitInput given;
  given.mu = 35.8;
  EXPECT_NEAR(fit_with_blades(record, given, table).fit.tau_0->value, 54.0, 0.02 * 54.0);
}

// Three values of a normal sample: mean, s and t(0.975, 2) s/sqrt(3) by hand.
TEST(Replicates, TheMeanHasTheIntervalOfTheScatterBetween) {
  std::vector<FitResult> fits(3);
  const double value[] = {90.0, 100.0, 110.0};
  for (std::size_t i = 0; i < 3; ++i)
    fits[i].tau_0 = ParameterEstimate{value[i], Interval{value[i] - 1.96, value[i] + 1.96}, false};
  const auto means = replicate_means(fits);
  ASSERT_EQ(means.size(), 1u);
  EXPECT_NEAR(*means[0].between, 0.1, 1e-12);
  EXPECT_NEAR(*means[0].within, 0.01, 1e-12);
  EXPECT_NEAR(means[0].mean.ci95->high, 100.0 + 4.3027 * 10.0 / std::sqrt(3.0), 1e-3);
  EXPECT_NEAR(*means[0].parameter.laboratories, 0.27, 1e-12);
}

// F with one degree of freedom above is t squared.
TEST(Statistics, FishersTailIsStudentsSquared) {
  EXPECT_NEAR(student_quantile(1.0 - 0.5 * fisher_tail(4.0, 1.0, 7.0), 7.0), 2.0, 1e-11);
}

}  // namespace
}  // namespace tremie
