// Small made-up files in the layouts of measured ones that public repositories hold, with what was read wrong or refused in
// them. The measured files themselves are not here.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "rheometer/records/sections.hpp"
#include "rheometer/records/torque_record.hpp"
#include "rheometer/whole_fit/fit_record.hpp"
#include "tests/rheometer/refusal.hpp"

namespace tremie {
namespace {

double rate(const TorqueRecord& r, std::size_t i) { return r.omega[i] / evenly_sheared_speed; }

// Published flow curves often have a viscosity in place of a stress.
TEST(FoundLayouts, StressIsViscosityTimesShearRate) {
  for (const char* text :
       {"Shear Rate [1/s]\tViscosity [mPa\u00B7s]\n10\t2550\n100\t11202.5\n",
        "Shear Rate;Viscosity\n[1/s];[Pa\u00B7s]\n10;2,55\n100;11,2025\n",
        "shear_rate_per_s,viscosity_cP\n10,2550\n100,11202.5\n",
        "\u526A\u5207\u901F\u7387\uFF081/s\uFF09,\u7C98\u5EA6\uFF08Pa\u00B7s\uFF09\n10,2.55\n100,11.2025\n",
        "Taxa de Cisalhamento (1/s);Viscosidade (Pa.s)\n10;2,55\n100;11,2025\n"}) {
    SCOPED_TRACE(text);
    TorqueRecord r;
    ASSERT_NO_THROW(r = parse_torque_record(text, "r.csv")) << refusal(text);
    ASSERT_EQ(r.torque.size(), 2u);
    EXPECT_NEAR(rate(r, 1), 100.0, 1e-9);
    EXPECT_NEAR(r.torque[0], 25.5, 1e-9);
    EXPECT_NEAR(r.torque[1], 1120.25, 1e-9);
    EXPECT_TRUE(understood(r, "viscosity times shear rate"));
  }
  // a stress of its own counts, and a viscosity beside speed and torque is nothing
  EXPECT_NEAR(
      parse_torque_record("Shear Rate [1/s],Viscosity [Pa.s],Shear Stress [Pa]\n10,9,25\n20,9,30\n", "r")
          .torque[0],
      25.0, 1e-12);
  EXPECT_NEAR(parse_torque_record("Speed [rpm],Torque [mN m],Viscosity\n10,9,x\n20,12,y\n", "r").torque[1],
              0.012, 1e-12);
}

// A line of empty fields parts the samples of a workbook.
TEST(FoundLayouts, ALineOfEmptyFieldsEndsATable) {
  const std::string text = "sample,RPM,Torque [mN m]\nA,1,10\nA,2,20\nA,3,30\n,,\nB,1,40\nB,2,50\nB,3,60\n";
  const TorqueRecord first = parse_torque_record(text, "r.csv");
  ASSERT_EQ(first.torque.size(), 3u);
  EXPECT_TRUE(understood(first, "table 1 of 2, lines 2 to 4; the other 3 rows are not used"));
  ReadOptions second;
  second.table = 2;
  EXPECT_NEAR(parse_torque_record(text, "r.csv", 0.0, second).torque[2], 0.06, 1e-12);
  // fewer than three rows are no table: a line between rows that was emptied
  EXPECT_EQ(parse_torque_record("RPM,Torque [mN m]\n1,10\n2,20\n,\n3,30\n", "r.csv").torque.size(), 3u);
}

// A viscometer's program wrote how long each reading took. As a clock it would run backwards at every other row.
TEST(FoundLayouts, ATimeOfEachReadingIsNoClock) {
  const TorqueRecord r = parse_torque_record(
      "RPM,Elapsed_Time_s,Torque [mN m]\n1,35,10\n2,20,20\n3,15,30\n1,20,11\n2,15,21\n3,15.1,31\n1,15,12\n",
      "r.csv");
  EXPECT_EQ(r.kind, RecordKind::flow_curve);
  EXPECT_EQ(r.torque.size(), 7u);
  EXPECT_TRUE(understood(r, "no clock of the test: it falls at 4 of 6 rows")) << r.understood.back();
}

// "torque_percent" is a share of the spring, and a column of True and False is no second torque.
TEST(FoundLayouts, ColumnsOfWordsAreNoSecondColumn) {
  ReadOptions brookfield;
  brookfield.full_scale_torque = 5.7496e-3;
  const TorqueRecord r =
      parse_torque_record("rpm,torque_percent,torque_valid,viscosity_cp\n2.5,26,True,105\n3,32,True,106\n",
                          "r.csv", 0.0, brookfield);
  ASSERT_EQ(r.torque.size(), 2u);
  EXPECT_NEAR(r.torque[0], 0.26 * 5.7496e-3, 1e-12);
  EXPECT_NEAR(parse_torque_record("rpm;torque [mN m];torque [limit]\n1;2;no\n2;3;no\n", "r").torque[1], 3e-3,
              1e-12);
}

// ICAR's vane, the default, has no spring: its size must not stand for a viscometer's spindle.
TEST(FoundLayouts, ASpringNeedsAGeometry) {
  ReadOptions brookfield;
  brookfield.full_scale_torque = 5.7496e-3;
  brookfield.shear_first = true;
  EXPECT_NE(refusal("RPM,Torque %\n1,2\n2,3\n", brookfield).find("give its geometry"), std::string::npos);
  brookfield.shear_first = false;
  EXPECT_EQ(refusal("RPM,Torque %\n1,2\n2,3\n", brookfield), "nothing");
}

// Exports that a program has cut at the left: the label of the header has no place in the rows. Read by place, the stress
// would be the shear rate.
TEST(FoundLayouts, RowsWithoutThePlaceOfTheLabel) {
  for (const std::string place : {"", "\t"}) {
    const TorqueRecord r = parse_torque_record(
        "Interval data:\tShear Rate\tShear Stress\tViscosity\n\t[1/s]\t[Pa]\t[Pa\u00B7s]\n" + place +
            "10\t25.5\t2.55\n" + place + "100\t1120\t11.2\n",
        "r.csv");
    ASSERT_EQ(r.torque.size(), 2u);
    EXPECT_NEAR(rate(r, 0), 10.0, 1e-9);
    EXPECT_NEAR(r.torque[0], 25.5, 1e-9);
  }
}

// An oscillation has a torque and an angular frequency as well; its rows are no rotation.
TEST(FoundLayouts, RowsOfAnOscillationAreLeftOut) {
  const std::string sweep =
      "t in s;omega in rad/s;G' in Pa;M in mNm\n1;100;35,8;0,01\n2;63;33,5;0,009\n3;40;31,4;0,008\n";
  EXPECT_NE(refusal(sweep).find("r.csv:1:1: the rows are those of an oscillation"), std::string::npos)
      << refusal(sweep);
  const TorqueRecord r = parse_torque_record(
      "Shear rate(s-\u00B9);Shear stress(Pa);Shear modulus (elastic "
      "component)(Pa)\n1;2;120\n2;3;130\n10;20;\n20;30;\n30;40;\n",
      "r.csv");
  ASSERT_EQ(r.torque.size(), 3u);
  EXPECT_NEAR(r.torque[0], 20.0, 1e-12);
  EXPECT_TRUE(understood(r, "2 rows of an oscillation left out"));
  EXPECT_NE(
      refusal("Meas. Pts.,Angular Frequency,Storage Modulus,Torque\n,[rad/s],[Pa],[mNm]\n1,100,35.8,0.01\n")
          .find("a modulus is of an oscillation"),
      std::string::npos);
}

// A step of an oscillation behind one of a rotation has columns of its own, more or as many. Its moduli would be stresses
// and rates by their places.
TEST(FoundLayouts, ATableOfOtherColumnsEndsTheOneBefore) {
  const std::string head = "[step]\nFlow sweep - 1\nStress,Shear rate,Viscosity\nPa,1/s,Pa.s\n",
                    flow = head + "20,10,2\n30,20,1.5\n40,30,1.33\n\n";
  for (const char* other :
       {"[step]\nAmplitude sweep - 2\nStorage modulus,Loss modulus,Oscillation torque\nPa,Pa,\u00B5N.m\n"
        "13.9,10.2,0.016\n14.5,7.6,0.02\n\n",
        "[step]\nTemperature - 2\nTemperature,Gap,Axial force,Step time\n\u00B0C,mm,N,s\n20,1,0.1,3\n"
        "20,1,0.1,4\n"}) {
    SCOPED_TRACE(other);
    TorqueRecord r;
    ASSERT_NO_THROW(r = parse_torque_record("Filename,x\n" + flow + other, "r.csv")) << refusal(flow + other);
    ASSERT_EQ(r.torque.size(), 3u);
    EXPECT_NEAR(r.torque[2], 40.0, 1e-12);
    EXPECT_TRUE(understood(r, "2 rows of tables with other columns left out"));
    // and the rotation behind it is read
    ReadOptions second;
    second.table = 2;
    EXPECT_NEAR(
        parse_torque_record("Filename,x\n" + flow + other + "\n" + flow, "r.csv", 0.0, second).torque[0],
        20.0, 1e-12);
  }
}

// A remark between two rows begins no table.
TEST(FoundLayouts, ARemarkBetweenRowsEndsNothing) {
  EXPECT_EQ(parse_torque_record(
                "Speed [rpm],Torque [Nm],Remark,By\n10,1,a,b\n20,1.5,a,b\npause,the mixer,was on,again\n"
                "30,2,a,b\n40,2.5,a,b\n",
                "r.csv")
                .torque.size(),
            4u);
}

// All columns without a unit are named at once.
TEST(FoundLayouts, UnitsThatAreMissingAreAskedForTogether) {
  EXPECT_NE(refusal("Shear Rate,Stress\n1,2\n2,3\n")
                .find("--column \"shear_rate=1 [unit]; shear_stress=2 [unit]\""),
            std::string::npos);
}

/// Rows "s,1/s,Pa" of a fluid of 0.2 Pa and 0.8 Pa s^0.75, a factor 1.26 between them.
std::string sweep(double from, double to, double first_time) {
  std::string text;
  const double factor = to > from ? 1.26 : 1.0 / 1.26;
  double time = first_time;
  for (double g = from; to > from ? g < to : g > to; g *= factor, time += 7.0)
    text += std::to_string(time) + "," + std::to_string(g) + "," +
            std::to_string(0.2 + 0.8 * std::pow(g, 0.75)) + "\n";
  return text;
}

std::vector<Section> sections_of(const std::string& text) {
  return find_sections(parse_protocol_record(text, "r.csv"));
}

// Sweeps over five decades of a fluid with a small yield stress: below 5e-4 of the highest rate its stress is less than 5 %
// of the largest. These rows tell the yield stress; they are no rest. Each step has a clock of its own.
TEST(FoundLayouts, TheSlowEndsOfTwoSweepsAreNoRest) {
  const std::string head = "[step]\nFlow sweep\nStep time,Shear rate,Stress\ns,1/s,Pa\n",
                    text = head + sweep(200.0, 0.005, 7.0) + "\n" + head + sweep(0.005, 200.0, 7.0);
  const std::vector<Section> sections = sections_of(text);
  ASSERT_EQ(sections.size(), 2u);
  EXPECT_EQ(sections[0].kind, SectionKind::flow_curve_down);
  EXPECT_EQ(sections[1].kind, SectionKind::flow_curve_up);
  EXPECT_EQ(sections[0].end, 46u);
  EXPECT_EQ(sections[1].end - sections[1].begin, 46u);
}

// The same under one clock, and two sweeps down one after the other.
TEST(FoundLayouts, RampsThatTurnAreParted) {
  const std::string head = "time_s,shear_rate_per_s,shear_stress_Pa\n";
  const std::vector<Section> valley = sections_of(head + sweep(200.0, 1.0, 0.0) + sweep(1.0, 200.0, 500.0));
  ASSERT_EQ(valley.size(), 2u);
  EXPECT_EQ(valley[0].kind, SectionKind::flow_curve_down);
  EXPECT_EQ(valley[1].kind, SectionKind::flow_curve_up);
  const std::vector<Section> twice = sections_of(head + sweep(200.0, 1.0, 7.0) + sweep(200.0, 1.0, 7.0));
  ASSERT_EQ(twice.size(), 2u);
  EXPECT_EQ(twice[0].kind, SectionKind::flow_curve_down);
  EXPECT_EQ(twice[1].kind, SectionKind::flow_curve_down);
  EXPECT_EQ(twice[0].end, twice[1].begin);
}

// A vane that stops within a row, and whose torque goes, rests.
TEST(FoundLayouts, AStopIsARest) {
  std::string text = "time_s,speed_rad_per_s,torque_N_m\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(i) + ",1.0,0.5\n";
  double creeping = 1e-4;
  for (int i = 20; i < 30; ++i, creeping *= 0.8)
    text += std::to_string(i) + "," + std::to_string(creeping) + ",0.001\n";
  const std::vector<Section> sections = sections_of(text);
  ASSERT_EQ(sections.size(), 2u);
  EXPECT_EQ(sections[1].kind, SectionKind::rest);
}

// A polymer's curve bends below the law at its fast end. Readings that are left out there are no chance: the fit says so.
TEST(FoundLayouts, AnEndThatTheLawDoesNotDescribeIsNamed) {
  std::string text = "Shear rate [1/s],Shear stress [Pa]\n";
  double g = 0.1;
  for (int i = 0; i < 40; ++i, g *= 1.25) {
    const double bent = i < 36 ? 1.0 : 0.95 - 0.02 * (i - 36), noise = i % 2 ? 1.003 : 0.997;
    text += std::to_string(g) + "," + std::to_string((20.0 + 8.0 * std::sqrt(g)) * bent * noise) + "\n";
  }
  const auto file = std::filesystem::temp_directory_path() / ("tremie_found_" + std::to_string(getpid()));
  std::ofstream(file, std::ios::binary) << text;
  FitOptions options;
  options.law = "herschel_bulkley";
  const FitResult f = fit_records({{.name = file.string()}}, options, {TREMIE_REFERENCE_DATA}).fits.front();
  std::filesystem::remove(file);
  EXPECT_NEAR(f.tau_0->value, 20.0, 0.4);
  EXPECT_EQ(std::count_if(f.notes.begin(), f.notes.end(),
                          [](const std::string& note) {
                            return note.starts_with("law: the 4 fastest readings lie below the curve");
                          }),
            1);
}

}  // namespace
}  // namespace tremie
