// Reading torque records: what is accepted in its several spellings, and a message with a position for what
// is not.

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "rheometer/records/torque_record.hpp"

namespace tremie {
namespace {

TorqueRecord parse(const std::string& text) { return parse_torque_record(text, "data.csv"); }

std::string message_of(const std::string& text) {
  try {
    parse(text);
  } catch (const RecordError& error) {
    return error.what();
  }
  return "no error";
}

void expect_message(const std::string& text, const std::string& start, const std::string& part) {
  const std::string message = message_of(text);
  EXPECT_TRUE(message.starts_with(start)) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(TorqueRecord, TheColumnsTellTheKind) {
  const TorqueRecord curve = parse("speed_rev_per_s,torque_N_m\n0.5,1.253\n0.25,0.801\n");
  EXPECT_EQ(curve.kind, RecordKind::flow_curve);
  EXPECT_DOUBLE_EQ(curve.omega[0], std::numbers::pi);
  EXPECT_DOUBLE_EQ(curve.torque[1], 0.801);
  EXPECT_EQ(curve.line[1], 3);
  const TorqueRecord decay = parse("time_s,torque_N_m\n0,2.0\n10,1.25\n");
  EXPECT_EQ(decay.kind, RecordKind::torque_decay);
  EXPECT_DOUBLE_EQ(decay.time[1], 10.0);
}

TEST(TorqueRecord, UnitsComeFromTheHeader) {
  EXPECT_DOUBLE_EQ(parse("speed_rpm,torque_mN_m\n30,1253\n").omega[0], std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse("speed_rpm,torque_mN_m\n30,1253\n").torque[0], 1.253);
  EXPECT_DOUBLE_EQ(parse("Speed (rad/s),Torque (mN·m)\n3.5,1253\n").omega[0], 3.5);
  EXPECT_DOUBLE_EQ(parse("Speed [rev/min],Torque [N.m]\n60,1.5\n").omega[0], 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse("time_min,torque_Nm\n2,1.5\n").time[0], 120.0);
  EXPECT_DOUBLE_EQ(parse("time_ms,torque (µN·m)\n2,1.5e6\n").torque[0], 1.5);
}

TEST(TorqueRecord, ReadsTheUsualVariantsOfCsv) {
  const std::string variants[] = {
      "time_s;torque_N_m\n0,5;2,25\n1;1,75\n",                                   // decimal comma
      "time_s;torque_N_m\n0.5;2.25\n1;1.75\n",                                   // semicolons, decimal point
      "time_s\ttorque_N_m\n0.5\t2.25\n1\t1.75\n",                                // tabs
      "\xEF\xBB\xBFtime_s,torque_N_m\r\n0.5,2.25\r\n1,1.75\r\n",                 // byte-order mark, CR LF
      "# ICAR\n\ntime_s,torque_N_m\n# a comment\n0.5,2.25\n\n  # more\n1,1.75",  // comments, blank lines, no
                                                                                 // last end
      "\"time_s\",\"torque_N_m\"\n\"0.5\", +2.25 \n1,1.75\n",                    // quotes, spaces, sign
      "torque_N_m,temperature_C,time_s\n2.25,21,0.5\n1.75,21,1\n"};              // other order, a column more
  for (const std::string& text : variants) {
    const TorqueRecord record = parse(text);
    ASSERT_EQ(record.time.size(), 2u) << text;
    EXPECT_DOUBLE_EQ(record.time[0], 0.5) << text;
    EXPECT_DOUBLE_EQ(record.torque[0], 2.25) << text;
    EXPECT_DOUBLE_EQ(record.torque[1], 1.75) << text;
  }
}

TEST(TorqueRecord, SaysWhereAndWhatIsWrong) {
  expect_message("", "data.csv:1:1: ", "empty");
  expect_message("# only a comment\n", "data.csv:1:1: ", "empty");
  expect_message("time_s,torque_N_m\n", "data.csv:1:1: ", "without rows");
  expect_message("time_s,torque_N_m\n0,2\n1,two\n", "data.csv:3:2: ", "'two' is not a number");
  expect_message("time_s,torque_N_m\n0,2\n1,\n", "data.csv:3:2: ", "no value");
  expect_message("time_s,torque_N_m\n0,nan\n", "data.csv:2:2: ", "not a number");
  expect_message("time_s,torque_N_m\n0,2\n2,1\n1,1\n", "data.csv:4:1: ", "backwards");
  expect_message("time_s,torque_N_m\n0,2\n1,-1\n", "data.csv:3:2: ", "negative");
  expect_message("speed_rpm,torque_N_m\n-30,2\n", "data.csv:2:1: ", "negative");
  expect_message("time_s,torque_lbf_ft\n0,2\n", "data.csv:1:2: ", "unknown unit");
  expect_message("speed_m_per_s,torque_N_m\n1,2\n", "data.csv:1:1: ", "speed_rev_per_s");
  expect_message("time,torque_N_m\n0,2\n", "data.csv:1:1: ", "no unit");
  expect_message("a,b\n0,2\n", "data.csv:1:1: ", "no torque column");
  expect_message("torque_N_m\n2\n", "data.csv:1:1: ", "neither");
  expect_message("time_s,speed_rpm,torque_N_m\n0,30,2\n", "data.csv:1:1: ", "no 8 rows of one speed");
  expect_message("time_s,time_ms,torque_N_m\n0,30,2\n", "data.csv:1:2: ", "second column");
  expect_message("time_s,torque_N_m\n0,5,2,25\n", "data.csv:2:2: ", "decimal comma");
  expect_message("time_s,torque_N_m\n0\n", "data.csv:2:1: ", "1 columns");
  expect_message(std::string("\xFF\xFEt\0i\0", 6), "data.csv:1:1: ", "no torque column");
  expect_message("speed_rpm,torque_N_m\n30,1e300\n", "data.csv:2:2: ", "unit");
  expect_message("speed_rpm,torque_N_m\n1e9,1\n", "data.csv:2:1: ", "unit");
  expect_message("speed_rpm,torque_N_m\n10,1e-300\n20,2e-300\n", "data.csv:2:2: ", "below 1e-12 N.m");
  expect_message("shear_rate_1_per_s,shear_stress_Pa\n1,1e-10\n2,2e-10\n", "data.csv:2:2: ", "below 1e-9 Pa");
  expect_message("shear_rate_1_per_s,shear_stress_Pa\n1,1\n2,1e12\n", "data.csv:3:2: ", "above 1e9 Pa");
  EXPECT_THROW(read_torque_record("/nonexistent/data.csv"), RecordError);
  EXPECT_THROW(read_torque_record("/"), RecordError);
}

}  // namespace
}  // namespace tremie
