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

// What a person means who writes no unit: the one in which the number is usual, and whose value the key allows.
TEST(Units, AMissingUnitIsTheOneThatIsMeant) {
  EXPECT_NE(message("590", Dimension::length).find("write \"590 mm\""), std::string::npos);
  EXPECT_EQ(unit_meant(0.59, Dimension::length), "m");
  EXPECT_EQ(unit_meant(15.0, Dimension::speed), "cm/s");
  EXPECT_EQ(unit_meant(0.15, Dimension::speed), "m/s");
  EXPECT_EQ(unit_meant(150.0, Dimension::speed), "mm/s");
  EXPECT_EQ(unit_meant(2400.0, Dimension::density), "kg/m3");
  EXPECT_EQ(unit_meant(2.4, Dimension::density), "g/cm3");
  EXPECT_EQ(unit_meant(0.25, Dimension::rotation), "rev/s");
  EXPECT_EQ(unit_meant(15.0, Dimension::rotation), "rpm");
  EXPECT_EQ(unit_meant(240.0, Dimension::time), "s");
  const auto spread = [](double value) { return value > 0.2 && value < 2.0; };
  EXPECT_EQ(unit_meant(59.0, Dimension::length, spread), "cm");
  EXPECT_EQ(unit_meant(1e9, Dimension::length, spread), "mm");  // none fits
}

TEST(Units, RoundedForAPersonHasNoExponent) {
  EXPECT_EQ(rounded(1042.3, 3), "1042");
  EXPECT_EQ(rounded(999.7, 3), "1000");
  EXPECT_EQ(rounded(54.04, 3), "54");
  EXPECT_EQ(rounded(0.03583, 3), "0.0358");
  EXPECT_EQ(rounded(-12345.6, 4), "-12346");
  EXPECT_EQ(rounded(120.0, 2), "120");
  EXPECT_EQ(rounded(0.0, 3), "0");
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
  EXPECT_EQ(write_at_most(0.1 / 3.0, Dimension::length), "0.03333 m");
  EXPECT_EQ(write_at_most(0.016, Dimension::length), "0.016 m");
  EXPECT_EQ(write_at_most(0.0, Dimension::length), "0 m");
  EXPECT_EQ(write_quantity(0.005, Dimension::length), "0.005 m");
  EXPECT_EQ(write_number(1e-7), "1e-07");
}

}  // namespace
}  // namespace tremie::scene
