// Files with tables of different columns, or with several samples in one table, as public repositories hold them. The files here
// are made; a Chandler 5550's calibration before its data and a list of muds by a Fann viscometer are their models.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "rheometer/protocol/protocol.hpp"
#include "rheometer/records/sections.hpp"
#include "rheometer/records/torque_record.hpp"
#include "tests/rheometer/refusal.hpp"

namespace tremie {
namespace {

const std::string curve = "shear rate [1/s],shear stress [Pa]\n10,1\n20,1.5\n30,2\n40,2.5\n";

// A table of two other columns is a table, with a unit in its header or below it, or by the numbers right below.
TEST(MixedTables, TwoOtherColumnsAreNoRows) {
  for (const std::string below :
       {"\nStrain [%],G' [Pa]\n20,2\n21,2.1\n", "Frequency [Hz],Temperature [C]\n20,2\n21,2.1\n",
        "\nRotor Radius,Bob Radius\n(cm),(cm)\n20,2\n21,2.1\n", "\nminute,temperature\n20,2\n21,2.1\n"}) {
    SCOPED_TRACE(below);
    const TorqueRecord r = parse_torque_record(curve + below, "r.csv");
    EXPECT_EQ(r.torque.size(), 4u);
    EXPECT_TRUE(understood(r, "2 rows of tables with other columns left out"));
  }
}

// The kind of table with the most rows is read; --table reads another. A torque without a speed needs a word from the user.
TEST(MixedTables, OneKindIsReadAndTheOtherIsTold) {
  const std::string calibration =
      "Rotor Speed,Shear Rate,Shear Stress\n(RPM),(1/sec),(dyne/cm2)\n10,8.5,17\n20,17,34\n30,25.5,51\n\n";
  std::string log = "Time (min),Shear Rate (1/sec),Shear Stress (dyne/cm2)\n";
  for (int i = 1; i <= 12; ++i)
    log += std::to_string(i) + "," + std::to_string(50 + 50 * i) + "," + std::to_string(140 + 60 * i) + "\n";
  const TorqueRecord r = parse_torque_record(calibration + log, "r.csv");
  ASSERT_EQ(r.torque.size(), 12u);
  EXPECT_NEAR(r.torque[0], 20.0, 1e-9);
  EXPECT_TRUE(understood(r, "3 rows of tables with other columns left out (--table reads another)"));
  ReadOptions first;
  first.table = 1;
  const TorqueRecord one = parse_torque_record(calibration + log, "r.csv", 0.0, first);
  ASSERT_EQ(one.torque.size(), 3u);
  EXPECT_NEAR(one.torque[2], 5.1, 1e-9);
  const std::string torques =
      "Time [s],Torque [mN m]\n1,5\n2,5\n3,5\n4,5\n5,5\n6,5\n\nspeed [rpm],torque [mN m]\n10,1\n20,2\n30,3\n";
  EXPECT_EQ(parse_torque_record(torques, "r.csv").torque.size(), 3u);
}

// Samples under one header are tables; where they alternate, or a time goes through, a note says that they are read as one.
TEST(MixedTables, SamplesOfOneTableAreToldApart) {
  const std::string header = "sample,ramp,shear rate [1/s],shear stress [Pa]\n";
  const std::string text =
      header +
      "CMC,up,10,1\nCMC,up,20,2\nCMC,up,30,3\nCMC,down,10,4\nCMC,down,20,5\nCMC,down,30,6\n"
      "TiO2,up,10,7\nTiO2,up,20,8\nTiO2,up,30,9\n";
  const TorqueRecord r = parse_torque_record(text, "r.csv");
  ASSERT_EQ(r.torque.size(), 3u);
  EXPECT_TRUE(understood(r, "lines 5 to 7 (CMC, down)"));
  ReadOptions third;
  third.table = 3;
  EXPECT_NEAR(parse_torque_record(text, "r.csv", 0.0, third).torque[0], 7.0, 1e-9);

  const TorqueRecord mixed = parse_torque_record(
      header + "A,up,10,1\nB,up,10,2\nA,up,20,3\nB,up,20,4\nA,up,30,5\nB,up,30,6\n", "r.csv");
  EXPECT_EQ(mixed.torque.size(), 6u);
  EXPECT_TRUE(
      understood(mixed, "column 1 'sample' changes (A, up to B, up); its rows are read as one record"));
  // a number of each row is no group
  const TorqueRecord rows =
      parse_torque_record("Run,shear rate [1/s],shear stress [Pa]\n1,10,1\n2,20,2\n3,30,3\n", "r.csv");
  EXPECT_EQ(rows.torque.size(), 3u);
  EXPECT_FALSE(understood(rows, "changes ("));
}

/// Three curves of Bingham concretes, 60, 64 and 68 Pa, below a column or a line that tells them apart.
std::string three_curves(const std::string& column, const std::vector<std::string>& values, bool as_title) {
  std::string text = (as_title ? "" : column + ",") + "Shear rate [1/s],Shear stress [Pa]\n";
  for (std::size_t g = 0; g < 3; ++g) {
    if (as_title) text += "mix " + values[g] + ",\n";
    for (int rate = 5; rate <= 50; rate += 5)
      text += (as_title ? "" : values[g] + ",") + std::to_string(rate) + "," +
              std::to_string(60 + 4 * static_cast<int>(g) + 2 * rate) + "\n";
  }
  return text;
}

// A column of any name parts a table where its rows go through the same rates again; so does a line with a text alone, and a
// time that stays the same over a whole curve, which is an age.
TEST(MixedTables, CurvesOfOneTableAreFoundByTheirRates) {
  for (const char* column :
       {"Age (min)", "W/C", "SP dosage (%)", "Time after mixing (min)", "anything", ""}) {
    SCOPED_TRACE(column);
    const std::string text = three_curves(column, {"0.45", "0.5", "0.55"}, *column == 0);
    ReadOptions options;
    for (std::size_t table = 1; table <= 3; ++table) {
      options.table = table;
      const TorqueRecord r = parse_torque_record(text, "r.csv", 0.0, options);
      ASSERT_EQ(r.torque.size(), 10u);
      EXPECT_NEAR(r.torque[0], 66.0 + 4.0 * static_cast<double>(table), 1e-9);
    }
  }
  // the steps of one curve, and an instrument's state, go on where the last one ended
  std::string steps = "Step,State,Shear rate [1/s],Shear stress [Pa]\n";
  for (int i = 0; i < 12; ++i)
    steps += std::to_string(i / 3) + (i < 6 ? ",low," : ",ok,") + std::to_string(5 + i) + ",60\n";
  EXPECT_EQ(parse_torque_record(steps, "r.csv").torque.size(), 12u);
}

// Means and deviations below the readings are none of them.
TEST(MixedTables, StatisticsAreNoReadings) {
  const TorqueRecord r = parse_torque_record(
      "No;Shear rate [1/s];Shear stress [Pa]\n1;10;1\n2;20;2\n3;30;3\nMean;20;2\nStd. dev.;10;1\n", "r.csv");
  EXPECT_EQ(r.torque.size(), 3u);
  EXPECT_TRUE(understood(r, "2 rows of statistics left out"));
  EXPECT_TRUE(understood(parse_torque_record(curve + "\n25,1.75\n", "r.csv"), "stand behind a blank line"));
}

// Numbers as Fortran writes them, and a clock of minutes and seconds.
TEST(MixedTables, NumbersAndClocksOfPrograms) {
  EXPECT_NEAR(
      parse_torque_record("Shear rate [1/s],Shear stress [Pa]\n1.0D+01,5.0D-01\n2.0D+01,7.5D-01\n", "r")
          .torque[1],
      0.75, 1e-12);
  std::string text = "Time (mm:ss),Torque [mN m]\n";
  for (int i = 0; i < 9; ++i) text += "01:0" + std::to_string(i) + ".5," + std::to_string(90 - i) + "\n";
  EXPECT_NEAR(parse_torque_record(text, "r.csv").time.back(), 68.5, 1e-9);
}

// Names and units of more languages and workshops; all are 10 and 20 1/s, 5 and 7 Pa, or 1 and 2 rad/s, 0.5 and 1 N m.
TEST(MixedTables, NamesAndUnitsOfMoreLanguages) {
  for (const char* text :
       {"Szybko\u015B\u0107 \u015Bcinania [1/s];Napr\u0119\u017Cenie \u015Bcinaj\u0105ce "
        "[Pa]\n10;5,0\n20;7,0\n",
        "Smykov\u00E1 rychlost [1/s];Smykov\u00E9 nap\u011Bt\u00ED [Pa]\n10;5,0\n20;7,0\n",
        "Kayma h\u0131z\u0131 (1/s);Kayma gerilmesi (Pa)\n10;5,0\n20;7,0\n",
        "\u305B\u3093\u65AD\u901F\u5EA6 [1/s],\u305B\u3093\u65AD\u5FDC\u529B [Pa]\n10,5.0\n20,7.0\n"}) {
    SCOPED_TRACE(text);
    const TorqueRecord r = parse_torque_record(text, "r.csv");
    EXPECT_NEAR(r.torque[1], 7.0, 1e-9);
    EXPECT_NEAR(r.omega[1] / evenly_sheared_speed, 20.0, 1e-9);
  }
  for (const char* text : {"Speed [rad/min],Torque [kgf cm]\n60,5.0985810\n120,10.1971621\n",
                           "Speed [rad/min],Torque [in-lb]\n60,4.4253729\n120,8.8507458\n"}) {
    const TorqueRecord r = parse_torque_record(text, "r.csv");
    EXPECT_NEAR(r.torque[1], 1.0, 1e-6);
    EXPECT_NEAR(r.omega[1], 2.0, 1e-9);
  }
}

// A print whose header comes again on every page is one curve if its speeds go on, and several if they come again.
TEST(MixedTables, PagesOfOneCurveAreReadTogether) {
  const auto page = [](int from, int stress) {
    std::string text = "Shear rate [1/s],Shear stress [Pa]\n";
    for (int i = from; i < from + 4; ++i) text += std::to_string(i) + "," + std::to_string(stress + i) + "\n";
    return text + "\n";
  };
  const TorqueRecord one = parse_torque_record(page(1, 50) + page(5, 50) + page(9, 50), "r.csv");
  EXPECT_EQ(one.torque.size(), 12u);
  EXPECT_TRUE(understood(one, "tables 1 to 3 of 3, lines 2 to 17: their speeds go on"));
  EXPECT_EQ(parse_torque_record(page(1, 50) + page(1, 60), "r.csv").torque.size(), 4u);
}

// Two columns whose names differ by their case alone: the one that is written as the user writes it is meant.
TEST(MixedTables, AColumnIsGivenByItsNameAsItIsWritten) {
  ReadOptions options;
  options.columns = "torque=T [mN m]; speed=n [rpm]";
  const TorqueRecord r = parse_torque_record("n,T,t\n10,1,0\n20,2,5\n30,3,10\n", "r.csv", 0.0, options);
  ASSERT_EQ(r.torque.size(), 3u);
  EXPECT_NEAR(r.torque[2], 0.003, 1e-12);
}

// 15.02 s for a reading, and 15.03 for the next: a clock that started again would start from the beginning.
TEST(MixedTables, ATimeThatHardlyFallsIsNoClock) {
  std::string text = "RPM,Elapsed_Time_s,Torque [mN m]\n";
  const char* time[] = {"35.08", "20.09", "15.02", "15.02", "15.02", "15.03",
                        "15.03", "15.02", "15.02", "15.03", "15.02"};
  for (int i = 0; i < 11; ++i)
    text += std::to_string(i + 2) + "," + time[i] + "," + std::to_string(40 + i) + "\n";
  const TorqueRecord r = parse_torque_record(text, "r.csv");
  EXPECT_EQ(r.kind, RecordKind::flow_curve);
  EXPECT_EQ(r.torque.size(), 11u);
}

// A sweep from 0.01 to 100 1/s in steps of one factor begins below a two-thousandth of its fastest rate. The stresses of an oil
// are noise there. A vane that runs down to a stand keeps no factor.
TEST(MixedTables, TheSlowEndOfASweepIsNoRest) {
  ProtocolRecord sweep;
  for (int i = 0; i < 25; ++i) {
    sweep.time.push_back(10.0 * i), sweep.omega.push_back(0.01 * std::pow(10.0, i / 6.0));
    sweep.torque.push_back(0.01 * sweep.omega.back() + (i % 2 == 0 ? 1e-4 : -2e-4));
    sweep.line.push_back(i + 2);
  }
  const auto sections = find_sections(sweep);
  ASSERT_EQ(sections.size(), 1u);
  EXPECT_EQ(sections[0].end - sections[0].begin, 25u);
  const double stop[] = {3e-4, 2.9e-4, 1e-4, 2e-6, 1e-6, 1e-7};
  for (std::size_t i = 0; i < 6; ++i) sweep.omega[i] = stop[i];
  EXPECT_EQ(find_sections(sweep).front().kind, SectionKind::rest);
}

}  // namespace
}  // namespace tremie
