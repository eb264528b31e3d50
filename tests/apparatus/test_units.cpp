#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "apparatus/scene/units.hpp"

namespace tremie::scene {
namespace {

std::string message(const char* text, Dimension dimension) {
  try {
    parse_quantity(text, dimension);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Units, EveryWayToWriteAQuantity) {
  EXPECT_EQ(parse_quantity("54 Pa", Dimension::pressure), 54.0);
  EXPECT_EQ(parse_quantity("0.01 MPa", Dimension::pressure), 1e4);
  EXPECT_EQ(parse_quantity("35.8Pa.s", Dimension::viscosity), 35.8);
  EXPECT_EQ(parse_quantity(" 35.8 Pa·s ", Dimension::viscosity), 35.8);
  EXPECT_EQ(parse_quantity("35 mm", Dimension::length), 0.035);  // the same double as "0.035 m"
  EXPECT_EQ(parse_quantity("15 cm/s", Dimension::speed), 0.15);
  EXPECT_EQ(parse_quantity("+4 min", Dimension::time), 240.0);
  EXPECT_EQ(parse_quantity("1e-4 s", Dimension::time), 1e-4);
  EXPECT_EQ(parse_quantity("2.4 g/cm3", Dimension::density), 2400.0);
  EXPECT_EQ(parse_quantity("0.1 1/s", Dimension::rate), 0.1);
  EXPECT_EQ(parse_quantity("1.3 Pa/s", Dimension::structuration), 1.3);
  EXPECT_DOUBLE_EQ(parse_quantity("15 rpm", Dimension::rotation),
                   parse_quantity("0.25 rev/s", Dimension::rotation));
  EXPECT_DOUBLE_EQ(parse_quantity("22.5 deg", Dimension::angle), 0.39269908169872414);
  EXPECT_DOUBLE_EQ(parse_quantity("0.25 rev/s", Dimension::rotation), 1.5707963267948966);
}

TEST(Units, WhatIsNoQuantitySaysWhatIsAllowed) {
  for (const char* text :
       {"54", "54 mm", "54 pa", "Pa", "", "nan Pa", "inf Pa", "1e400 Pa", "54,5 Pa", "0x10 Pa", "5 4 Pa"}) {
    const std::string what = message(text, Dimension::pressure);
    EXPECT_NE(what.find("Pa, kPa, MPa"), std::string::npos) << text << " -> " << what;
  }
  EXPECT_NE(message("54", Dimension::pressure).find("\"54 Pa\""), std::string::npos);
}

TEST(Units, AQuantityReadsBackBitForBit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 10000; ++i) {
    const double value = std::pow(10.0, exponent(random));
    EXPECT_EQ(parse_quantity(write_quantity(value, Dimension::length), Dimension::length), value);
  }
  for (const double value :
       {0.0, 1e-4, 1e6, std::numeric_limits<double>::min(), std::numeric_limits<double>::max()})
    EXPECT_EQ(parse_quantity(write_quantity(value, Dimension::time), Dimension::time), value);
}

TEST(Units, PlainNumbersStayReadable) {
  EXPECT_EQ(write_quantity(1e6, Dimension::pressure), "1000000 Pa");
  EXPECT_EQ(write_quantity(0.005, Dimension::length), "0.005 m");
  EXPECT_EQ(write_number(1e-7), "1e-07");
}

}  // namespace
}  // namespace tremie::scene
