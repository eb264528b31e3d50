// Records in the layouts of instruments and workshops. All are made: each holds the same few readings, so that what is
// read is known. Numbers that can be read in two ways are refused.

#include <gtest/gtest.h>

#include <string>

#include "libmpm/constitutive/constants.hpp"
#include "rheometer/records/torque_record.hpp"
#include "rheometer/reference/instrument.hpp"
#include "tests/rheometer/refusal.hpp"

namespace tremie {
namespace {

ReadOptions with_columns(const std::string& columns) {
  ReadOptions options;
  options.columns = columns;
  return options;
}

ReadOptions shear_first() {
  ReadOptions options;
  options.shear_first = true;
  return options;
}

void expect_refusal(const std::string& text, const std::string& start, const std::string& part) {
  const std::string message = refusal(text);
  EXPECT_TRUE(message.starts_with(start)) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

/// Two readings: 0.5 and 1 rev/s, 1234.5 and 2001.25 mN m.
void expect_flow_curve(const std::string& text, const ReadOptions& options = {}) {
  SCOPED_TRACE(text);
  TorqueRecord r;
  ASSERT_NO_THROW(r = parse_torque_record(text, "r.csv", 0.0, options)) << refusal(text, options);
  ASSERT_EQ(r.kind, RecordKind::flow_curve);
  ASSERT_EQ(r.torque.size(), 2u);
  EXPECT_FALSE(r.sheared_evenly);
  EXPECT_NEAR(r.omega[0], 0.5 * two_pi, 1e-12);
  EXPECT_NEAR(r.omega[1], two_pi, 1e-12);
  EXPECT_NEAR(r.torque[0], 1.2345, 1e-12);
  EXPECT_NEAR(r.torque[1], 2.00125, 1e-12);
}

/// Two readings: 10 and 100 1/s, 25.5 and 1120.25 Pa.
void expect_sheared(const std::string& text, const ReadOptions& options = {}) {
  SCOPED_TRACE(text);
  TorqueRecord r;
  ASSERT_NO_THROW(r = parse_torque_record(text, "r.csv", 0.0, options)) << refusal(text, options);
  ASSERT_TRUE(r.sheared_evenly);
  ASSERT_EQ(r.torque.size(), 2u);
  EXPECT_NEAR(r.omega[0] / evenly_sheared_speed, 10.0, 1e-9);
  EXPECT_NEAR(r.omega[1] / evenly_sheared_speed, 100.0, 1e-9);
  EXPECT_NEAR(r.torque[0], 25.5, 1e-9);
  EXPECT_NEAR(r.torque[1], 1120.25, 1e-9);
}

TEST(RecordLayouts, SpeedAndTorqueOfManyInstruments) {
  // workshop CSV, English and German, with thousands separators and quotes
  expect_flow_curve("Speed [rpm]\tTorque [N mm]\n30\t1,234.5\n60\t2,001.25\n");
  expect_flow_curve("Drehzahl [1/min];Drehmoment [mNm]\n30;1.234,5\n60;2.001,25\n");
  expect_flow_curve("Speed [rpm],Torque [mN m]\n30,\"1234,5\"\n60,\"2001,25\"\n");
  expect_flow_curve("Speed [rpm],Torque [mN m]\n30,\"1,234.5\"\n60,\"2,001.25\"\n");
  expect_flow_curve("Speed (rpm),Torque (mN-m)\n30,1 234.5\n60,2 001.25\n");
  expect_flow_curve("Speed (rpm);Torque (mN-m)\n30;1'234.5\n60;2'001.25\n");
  expect_flow_curve("n [min\u207B\u00B9];M [mNm]\n30;1234,5\n60;2001,25\n");
  expect_flow_curve("Drehzahl / min^-1;Moment / mNm\n30;1234,5\n60;2001,25\n");
  expect_flow_curve("Drehzahl in U/min;Moment in mNm\n30;1234,5\n60;2001,25\n");
  expect_flow_curve("vitesse de rotation (tr/min);couple (mN.m)\n30;1234,5\n60;2001,25\n");
  expect_flow_curve("RPM,Torque (\xB5N.m)\n30,1234500\n60,2001250\n");         // the byte of Latin-1
  expect_flow_curve("RPM,Torque (\u03BCN\u00B7m)\n30,1234500\n60,2001250\n");  // Greek
  // numbers with text around them: an ICAR-like log
  expect_flow_curve(
      "Flow curve test\nMix: A; 12.3.2024\n\nPoint,Speed (rev/s),Torque (Nm),Comment\n"
      "1,0.5,1.2345,\n2,1.0,2.00125,\"last, and fastest\"\n\nYield stress,54,Pa\n");
  // blanks between the columns, and numpy's comment
  expect_flow_curve("Speed [rpm]   Torque [mN m]\n   30        1234.5\n   60        2001.25\n");
  expect_flow_curve("# speed_rpm torque_mN_m\n30 1234.5\n60 2001.25\n");
  // a field of two lines, as workbooks have it
  expect_flow_curve("\"Speed\n[rpm]\";\"Torque\n[mN m]\"\n30;1234.5\n60;2001.25\n");
}

TEST(RecordLayouts, ShearRatesAndStressesOfManyInstruments) {
  // RheoCompass: German, English, French
  expect_sheared(
      "Projekt:\tP\nAbschnitt und Datenpunkte:\t1\t2\nAbschnittsdaten:\tPunkt "
      "Nr.\tScherrate\tSchubspannung\tViskosit\u00E4t\n"
      "\t\t\t\t\n\t\t[1/s]\t[Pa]\t[Pa\u00B7s]\n\t1\t10\t25,5\t2,55\n\t2\t100\t1.120,25\t11,2\n");
  expect_sheared(
      "Project:,P\nInterval and data points:,1,2\nInterval data:,Point No.,Shear Rate,Shear "
      "Stress\n,,,\n,,[1/s],[Pa]\n"
      ",1,10,25.5\n,2,100,1120.25\n");
  expect_sheared(
      "Projet:\tP\nIntervalle et points de donn\u00E9es:\t1\t2\nInterval donn\u00E9es:\tPoint No.\tGradient "
      "de "
      "Cisaillement\tContrainte de "
      "Cisaillement\n\t\t\t\n\t\t[1/s]\t[Pa]\n\t1\t10\t25,5\n\t2\t100\t1120,25\n");
  // TRIOS: a step with its unit row, without brackets
  expect_sheared(
      "Filename\tx.tri\nOperator\tA\n\n[step]\nFlow sweep - 1\nStress\tShear rate\tViscosity\tTemperature\n"
      "Pa\t1/s\tPa.s\t\u00B0C\n25.5\t10\t2.55\t20\n1120.25\t100\t11.2\t20\n");
  // rSpace
  expect_sheared(
      "Action Name;Shear rate(s-\u00B9);Shear stress(Pa);Torque(N m)\nA;10;25,5;0,001\nA;100;1120,25;0,04\n");
  // RheoWin
  expect_sheared(
      "HAAKE RheoWin 4.30\nSubstance;x\n\nGP in 1/s;Tau in Pa;Eta in Pas\n10;25,5;2,55\n100;1120,25;11,2\n");
  // Brookfield: dyne/cm2
  expect_sheared(
      "Shear Stress (dyne/cm\u00B2),Shear Rate (1/sec),Temperature (C)\n255,10,20.1\n11202.5,100,20.2\n");
  // both pairs of columns: the instrument's conversion where no geometry is given
  expect_sheared(
      "Speed [rpm],Torque [mN m],Shear Rate [1/s],Shear Stress [Pa]\n30,2,10,25.5\n60,3,100,1120.25\n",
      shear_first());
}

// Rheocalc writes a clock's time, without a unit.
TEST(RecordLayouts, AClocksTimeIsInSeconds) {
  const TorqueRecord r =
      parse_torque_record("Time,Torque (mN m)\n00:00:01.5,8\n00:01:00,7\n01:00:00,6\n", "r.csv");
  EXPECT_DOUBLE_EQ(r.time[0], 1.5);
  EXPECT_DOUBLE_EQ(r.time[2], 3600.0);
}

// Two steps are two flow curves: the first is read, or the one that is asked for. A header that is repeated within a table
// begins none.
TEST(RecordLayouts, OfSeveralTablesOneIsRead) {
  const std::string head = "[step]\nFlow\nShear rate\tStress\n1/s\tPa\n",
                    text = "Filename\tx\n" + head + "1\t2\n10\t20\n\n" + head + "1\t3\n10\t30\n";
  const TorqueRecord first = parse_torque_record(text, "r.csv");
  ASSERT_EQ(first.torque.size(), 2u);
  EXPECT_DOUBLE_EQ(first.torque[1], 20.0);
  EXPECT_NE(first.understood.back().find("table 1 of 2, lines 6 to 7"), std::string::npos)
      << first.understood.back();
  ReadOptions second;
  second.table = 2;
  EXPECT_DOUBLE_EQ(parse_torque_record(text, "r.csv", 0.0, second).torque[1], 30.0);
  second.table = 3;
  EXPECT_NE(refusal(text, second).find("the file has 2"), std::string::npos);
  const TorqueRecord repeated =
      parse_torque_record("speed_rpm;torque_N_m\n30;2\nspeed_rpm;torque_N_m\n20;1\n", "r.csv");
  EXPECT_EQ(repeated.torque.size(), 2u);
}

TEST(RecordLayouts, SpringsOfDialsAndShares) {
  ReadOptions fann, brookfield;
  fann.torque_per_degree = 3.6379e-5;
  brookfield.full_scale_torque = 7.187e-4;
  EXPECT_NEAR(parse_torque_record("RPM,Dial reading\n600,60\n300,45.5\n", "r", 0.0, fann).torque[1],
              45.5 * 3.6379e-5, 1e-12);
  EXPECT_NEAR(parse_torque_record("Speed (RPM);% Torque\n10;50\n20;75\n", "r", 0.0, brookfield).torque[1],
              5.39025e-4, 1e-12);
  expect_refusal("RPM,Dial reading\n600,60\n", "r.csv:1:2: ", "fann_r1b1");
  expect_refusal("Speed (RPM),Torque (%)\n600,60\n", "r.csv:1:2: ", "--full-scale-torque");
}

TEST(RecordLayouts, Utf16WithAndWithoutAMark) {
  std::string wide;
  for (const char c : std::string("Drehzahl [1/min]\tMoment [mNm]\r\n30\t1234,5\r\n60\t2001,25\r\n"))
    (wide += c) += '\0';
  expect_flow_curve(wide);
  expect_flow_curve("\xFF\xFE" + wide);
}

TEST(RecordLayouts, ColumnsByTheUsersWord) {
  const std::string text = "Kanal 1;Kanal 2 [U];Kanal 3\n7;30;1234,5\n8;60;2001,25\n";
  expect_flow_curve(text, with_columns("speed=2 [rpm]; torque=3 [mN m]"));
  expect_flow_curve(text, with_columns("speed=Kanal 2 [rpm]; torque=kanal 3 [mNm]"));
  expect_flow_curve("30;1234,5\n60;2001,25\n", with_columns("speed=1 [rpm]; torque=2 [mN m]"));
  expect_flow_curve("a [rpm];b [mN m]\n30;1234,5\n60;2001,25\n", with_columns("speed=rpm; torque=mN m"));
  EXPECT_NE(refusal(text, with_columns("force=3")).find("quantities are time, speed, torque"),
            std::string::npos);
  EXPECT_NE(refusal(text, with_columns("torque=3 [lbf]")).find("unknown unit"), std::string::npos);
}

TEST(RecordLayouts, ANumberIsReadOrRefused) {
  const std::string head = "Speed [rpm];Torque [mN m]\n";
  // one mark before three digits: a comma may be either, unless the file tells
  expect_refusal(head + "30;8,408\n24;7,650\n", "r.csv:2:2: ", "can be 8.408 or 8408");
  expect_refusal(head + "0,5;8.408\n0,7;7.650\n", "r.csv:2:2: ", "can be 8408 or 8.408");
  EXPECT_NEAR(parse_torque_record(head + "30.5;8,408\n24.5;7,650\n", "r").torque[0], 8.408, 1e-12);
  EXPECT_NEAR(parse_torque_record(head + "30,5;8,408\n24,5;7,650\n", "r").torque[0], 8.408e-3, 1e-12);
  EXPECT_NEAR(parse_torque_record(head + "30;0,408\n24;7,650\n", "r").torque[1], 7.650e-3, 1e-12);
  EXPECT_NEAR(parse_torque_record(head + "30;8.408\n24;7.650\n", "r").torque[0], 8.408e-3, 1e-12);
  // one reader for the column
  EXPECT_NEAR(parse_torque_record(head + "30;8.408,8\n24;1.146\n", "r").torque[1], 1.146, 1e-12);
  expect_refusal(head + "30;8.408,8\n24;1.46\n", "r.csv:3:2: ", "a column has one form");
  expect_refusal(head + "30;8,5\n24;7.5\n", "r.csv:3:2: ", "'8,5' on line 2");
  // groups of three alone are thousands
  expect_refusal(head + "30;8,40,8\n", "r.csv:2:2: ", "is not a number");
  expect_refusal(head + "30;1.2.3\n", "r.csv:2:2: ", "is not a number");
  ReadOptions comma;
  comma.decimal = "comma";
  EXPECT_NEAR(parse_torque_record(head + "30;8,408\n", "r", 0.0, comma).torque[0], 8.408e-3, 1e-12);
}

TEST(RecordLayouts, MessagesSayWhatWasSeenAndWhatIsMissing) {
  expect_refusal("Kanal A;Kanal B\n1;2\n", "r.csv:1:1: ", "line 1 has 'Kanal A', 'Kanal B'");
  expect_refusal("x\n\nSpeed [rpm],Torque [Nm]\n30,8,41\n", "r.csv:4:2: ", "a decimal comma needs quotes");
  expect_refusal("Speed [rpm];Torque [Nm];Torque [Nm]\n30;8;9\n", "r.csv:1:3: ", "--column torque=3");
  expect_refusal("Speed [rpm];Torque [furlong]\n30;8\n", "r.csv:1:2: ", "unknown unit");
}

// A sweep over decades that --geometry's cylinders made: no rest in it, however slow its last rows are.
TEST(RecordLayouts, ASlowSweepIsNoRest) {
  std::string text = "time_s,speed_rad_per_s,torque_N_m\n";
  double speed = 50.0;
  for (int i = 0; i < 20; ++i, speed /= 2.0)
    text += std::to_string(15 * i) + "," + std::to_string(speed) + "," + std::to_string(1e-3 + 1e-4 * speed) +
            "\n";
  const TorqueRecord r = parse_torque_record(text, "r.csv");
  EXPECT_EQ(r.kind, RecordKind::flow_curve);
  EXPECT_EQ(r.torque.size(), 20u);
}

}  // namespace
}  // namespace tremie
