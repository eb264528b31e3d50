// Records as instruments write them. The one of rheocem is measured; the others are made, in the layouts named.

#include <gtest/gtest.h>

#include "rheometer/fits/fit.hpp"
#include "rheometer/records/torque_record.hpp"

namespace tremie {
namespace {

std::string complaint(const std::string& text) {
  try {
    parse_torque_record(text, "r.csv");
  } catch (const RecordError& error) {
    return error.what();
  }
  return "";
}

// The first section of the measured file: 40 rpm; row 3 is 1.5 s, 40.001 1/min, 158.24 mN.m on line 13.
TEST(InstrumentExport, ReadsTheMeasuredExport) {
  const TorqueRecord r = read_torque_record(TREMIE_REFERENCE_DATA "/rheocem/SYS_0.55_250_1.csv");
  ASSERT_EQ(r.kind, RecordKind::torque_decay);
  EXPECT_NEAR(r.speed, angular_speed(40.0 / 60.0), 1e-3);
  EXPECT_EQ(r.line.front(), 12);  // the peak, while the vane gathers speed
  EXPECT_DOUBLE_EQ(r.time.front(), 0.0);
  EXPECT_NEAR(r.torque.front(), 0.22721, 1e-12);
  EXPECT_GE(r.understood.size(), 5u);
}

// Made in the layout of an ICAR-like log: Latin-1, semicolons, decimal commas with thousands points, a repeated header.
TEST(InstrumentExport, ReadsLatin1WithDecimalCommasAndARepeatedHeader) {
  std::string text =
      "Pr\xFC"
      "fung;1\n\nZeit [s];Drehzahl [1/min];Moment [mNm];Bemerkung\n";
  for (int i = 0; i < 10; ++i) {
    text += std::to_string(i) + ",5;15;1." + std::to_string(900 - i) + ",25;\n";
    if (i == 4) text += "Zeit [s];Drehzahl [1/min];Moment [mNm];Bemerkung\n";
    if (i == 6) text += "6,7;15;;ohne Wert\n";
  }
  const TorqueRecord r = parse_torque_record(text, "r.csv");
  ASSERT_EQ(r.torque.size(), 10u);
  EXPECT_NEAR(r.torque[1], 1.89925, 1e-12);
  EXPECT_EQ(r.line[5], 10);
  EXPECT_NEAR(r.speed, angular_speed(0.25), 1e-12);
}

// Made in the layout of a mortar rheometer: tabs, units in a line of their own, no time.
TEST(InstrumentExport, ReadsAFlowCurveWithUnitsBelowTheHeader) {
  const TorqueRecord r =
      parse_torque_record("Mischung A\nDrehzahl\tMoment\n[U/min]\t[N mm]\n30\t12,5\n60\t20\n", "r.csv");
  EXPECT_EQ(r.kind, RecordKind::flow_curve);
  EXPECT_NEAR(r.torque[0], 0.0125, 1e-15);
  EXPECT_NEAR(r.omega[1], angular_speed(1.0), 1e-12);
}

TEST(InstrumentExport, SaysWhatCannotBeRead) {
  EXPECT_NE(complaint(std::string("PK\x03\x04xx", 6)).find("Save as"), std::string::npos);
  EXPECT_NE(complaint(std::string("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16)).find("no text"), std::string::npos);
  const std::string no_unit = complaint("Zeit\tMoment\n1\t2\n");
  EXPECT_NE(no_unit.find("r.csv:1:1"), std::string::npos);
  EXPECT_NE(no_unit.find("unit"), std::string::npos);
}

}  // namespace
}  // namespace tremie
