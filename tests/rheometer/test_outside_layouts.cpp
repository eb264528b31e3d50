// Whole files as the exports of five instruments look, given to the fit as their owners would. All are made: layouts after
// public readers of the formats, numbers by 20 Pa + 8 Pa s^0.5 rate^0.5, and for the vane by Reiner and Riwlin, 60 Pa and
// 20 Pa s, alternately 1 % too large and too small.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "rheometer/whole_fit/fit_record.hpp"

namespace tremie {
namespace {

template <class... Values>
std::string line_of(const char* format, Values... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// `row` of each reading: number, rate, stress.
template <class Row>
std::string rows_of(Row row) {
  std::string text;
  int number = 0;
  for (const double rate : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0})
    text += row(++number, rate, 20.0 + 8.0 * std::sqrt(rate));
  return text;
}

FitResult fit_of(const std::string& text) {
  const auto file = std::filesystem::temp_directory_path() / ("tremie_layout_" + std::to_string(getpid()));
  std::ofstream(file, std::ios::binary) << text;
  FitOptions options;
  options.law = "auto";
  FitResult f = fit_records({{.name = file.string()}}, options, {TREMIE_REFERENCE_DATA}).fits.front();
  std::filesystem::remove(file);
  return f;
}

/// The exports have five digits: 0.1 % of the parameters.
void expect_herschel_bulkley(const std::string& text) {
  SCOPED_TRACE(text);
  const FitResult f = fit_of(text);
  ASSERT_EQ(f.model, "herschel_bulkley");
  EXPECT_TRUE(f.reasons.empty());
  EXPECT_TRUE(f.sheared_evenly);
  EXPECT_NEAR(f.tau_0->value, 20.0, 0.02);
  EXPECT_NEAR(f.of_law.at("consistency")->value, 8.0, 0.008);
  EXPECT_NEAR(f.of_law.at("flow_index")->value, 0.5, 5e-4);
}

TEST(OutsideLayouts, BrookfieldDv3t) {
  expect_herschel_bulkley(
      "Program: Flow curve\nSpindle: SC4-27\n\nStep [#],Point [#],Time [s],Viscosity [cP],Torque [%],Speed "
      "[RPM],Shear Stress [D/cm\u00B2],Shear Rate [1/s],Temperature [\u00B0C]\n" +
      rows_of([](int i, double rate, double stress) {
        return line_of("%d,1,%d.0,%.1f,%.1f,%.2f,%.2f,%.2f,23.0\n", i, 30 * i, 1000.0 * stress / rate,
                       stress / 3.0, rate / 0.34, 10.0 * stress, rate);
      }));
}

TEST(OutsideLayouts, RheoCompassAsUtf16) {
  const std::string text =
      "Project:\tCement\r\nTest:\tFlow curve 1\r\nInterval and data points:\t1\t8\r\nInterval data:\tPoint "
      "No.\tTime\tShear Rate\tShear Stress\tTorque\r\n\t\t\t\t\t\r\n\t\t[s]\t[1/s]\t[Pa]\t[mN.m]\r\n" +
      rows_of([](int i, double rate, double stress) {
        return line_of("\t%d\t%d\t%.5g\t%.6g\t%.4g\r\n", i, 10 * i, rate, stress, stress / 50.0);
      });
  std::string wide("\xFF\xFE", 2);
  for (const char c : text) wide += {c, '\0'};
  expect_herschel_bulkley(wide);
}

TEST(OutsideLayouts, TriosSteps) {
  expect_herschel_bulkley(
      "Filename\tflow.tri\nInstrument type\tDHR-2\nGeometry name\t40mm parallel plate\n\n[step]\nFlow sweep "
      "- "
      "1\nStress\tShear rate\tViscosity\tStep time\tTemperature\nPa\t1/s\tPa.s\ts\t\u00B0C\n" +
      rows_of([](int i, double rate, double stress) {
        return line_of("%.6g\t%.6g\t%.6g\t%d\t25.00\n", stress, rate, stress / rate, 20 * i);
      }));
}

TEST(OutsideLayouts, RheoWinInGerman) {
  std::string rows = rows_of([](int i, double rate, double stress) {
    return line_of(";%d;%d.00;%.3f;%.3f;%.2f;20.0\n", i, 10 * i, rate, stress, 1000.0 * stress / rate);
  });
  for (char& c : rows) c = c == '.' ? ',' : c;
  expect_herschel_bulkley(
      "Company / Operator;;;\nDate / Time / Version;01.02.2024 / 10:00:00;HAAKE RheoWin 4.87;\n;Nr;t_seg in "
      "s;\u03B3\u0307 in 1/s;\u03C4 in Pa;\u03B7 in mPas;T in \u00B0C\n" +
      rows);
}

// 1 % of the readings is 5 % of the yield stress and 6 % of the viscosity at most.
TEST(OutsideLayouts, AVaneForConcrete) {
  std::string text = "ICAR flow curve test\nVane radius 63.5 mm\n\nPoint,Speed (rev/s),Torque (Nm)\n";
  const double speeds[] = {0.5, 0.425, 0.35, 0.275, 0.2, 0.125, 0.05};
  for (int i = 0; i < 7; ++i)
    text += line_of("%d,%g,%.4f\n", i + 1, speeds[i],
                    reiner_riwlin({60.0, 20.0}, angular_speed(speeds[i])).torque * (i % 2 ? 0.99 : 1.01));
  const FitResult f = fit_of(text);
  EXPECT_EQ(f.model, "bingham");
  EXPECT_NEAR(f.tau_0->value, 60.0, 3.0);
  EXPECT_NEAR(f.mu->value, 20.0, 1.2);
  EXPECT_TRUE(f.tau_0->ci95->low < 60.0 && 60.0 < f.tau_0->ci95->high);
}

}  // namespace
}  // namespace tremie
