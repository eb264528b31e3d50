// Calibration as a person runs it: truth from a direct run, and measurements that cannot both be.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

const std::string unknown =
    "[unknown]\n\"mix.yield_stress\" = [\"20 Pa\", \"200 Pa\"]\n\"mix.plastic_viscosity\" = [\"10 Pa.s\", "
    "\"100 "
    "Pa.s\"]\n[known]\n\"mix.density\" = \"2400 kg/m3\"\n";

std::string measured(const std::string& spread, const std::string& t500) {
  return "[[measured]]\napparatus = \"slump_flow\"\nspread = \"" + spread +
         "\"\nspread_error = \"15 mm\"\nt500 = \"" + t500 + "\"\nt500_error = \"0.3 s\"\n";
}

// Mix A, 54 Pa and 35.8 Pa.s, spreads 555 mm and reaches 500 mm at 2.56 s in a direct run: both lie within the
// intervals, and the best value within half of each interval's width.
TEST(Calibrate, FindsTheMixOfADirectRun) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "LAB.toml", measured("555 mm", "2.56 s") + unknown);
  const auto result = test::shell("'" TREMIE_PROGRAM "' calibrate LAB.toml --out cal --next", folder.path());
  ASSERT_EQ(result.code, 0) << result.text;
  const auto results = nlohmann::json::parse(test::read_file(folder / "cal/summary.json"))["results"];
  const double truth[] = {54.0, 35.8};
  const char* keys[] = {"mix.yield_stress", "mix.plastic_viscosity"};
  for (int i = 0; i < 2; ++i) {
    const auto& p = results["parameters"][keys[i]];
    EXPECT_LT(p["ci95"][0], truth[i]);
    EXPECT_GT(p["ci95"][1], truth[i]);
    EXPECT_NEAR(p["value"].get<double>(), truth[i], 0.1 * truth[i]);
    EXPECT_EQ(p["told"], "identified");
  }
  EXPECT_LT(results["emulator_error"]["over_measurement_error"], 1.0 / 3.0);
  // What to measure next: the most telling first. A spread is measured here already, so that another is worth about what
  // halves its variance, half a bit.
  const auto& next = results["next"];
  ASSERT_GT(next.size(), 3u);
  for (std::size_t i = 1; i < next.size(); ++i) EXPECT_LE(next[i]["bits"], next[i - 1]["bits"]);
  for (const auto& advice : next)
    if (advice["result"] == "spread_mm") {
      EXPECT_NEAR(advice["bits"].get<double>(), 0.5, 0.3);
    }
  EXPECT_EQ(test::shell("'" TREMIE_PROGRAM "' run cal/mix.toml --set test.duration=\"0.1 s\" --quiet",
                        folder.path())
                .code,
            0);
}

TEST(Calibrate, AKeyIsKnownOrUnknown) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "LAB.toml",
                   measured("555 mm", "2.56 s") + unknown + "\"mix.yield_stress\" = \"50 Pa\"\n");
  const auto result = test::shell("'" TREMIE_PROGRAM "' calibrate LAB.toml --out cal", folder.path());
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.text.find("mix.yield_stress: is in [known], too"), std::string::npos) << result.text;
}

// A mini cone by its name, from a direct run of 30 Pa; the slump flow that follows is within the forecast's interval.
TEST(Calibrate, TakesAConeByItsName) {
  const test::TemporaryFolder folder;
  const std::string tremie = "'" TREMIE_PROGRAM "' ";
  const auto direct = [&](const std::string& cone) {
    test::shell(tremie + "new slump_flow > s.toml", folder.path());
    const auto run = test::shell(
        tremie + "run s.toml --force --quiet --out r --set mix.yield_stress=30Pa --set cone=" + cone +
            " --set test.duration=100000s",
        folder.path());
    EXPECT_EQ(run.code, 0) << run.text;
    return nlohmann::json::parse(test::read_file(folder / "r/summary.json"))["results"]["spread_mm"]
        .get<double>();
  };
  const double mini = direct("haegermann"), full = direct("abrams");
  test::write_file(
      folder / "LAB.toml",
      "[[measured]]\napparatus = \"slump_flow\"\ncone = \"haegermann\"\nspread = \"" + std::to_string(mini) +
          " mm\"\nspread_error = \"3 mm\"\n[unknown]\n\"mix.yield_stress\" = [\"10 Pa\", \"100 "
          "Pa\"]\n[known]\n"
          "\"mix.plastic_viscosity\" = \"35.8 Pa.s\"\n[[forecast]]\napparatus = \"slump_flow\"\ncone = "
          "\"abrams\"\n");
  const auto result = test::shell(tremie + "calibrate LAB.toml --out cal", folder.path());
  ASSERT_EQ(result.code, 0) << result.text;
  const auto results = nlohmann::json::parse(test::read_file(folder / "cal/summary.json"))["results"];
  const auto& p = results["parameters"]["mix.yield_stress"];
  EXPECT_LT(p["ci95"][0], 30.0);
  EXPECT_GT(p["ci95"][1], 30.0);
  const auto& forecast = results["forecast"][0]["spread_mm"]["ci95"];
  EXPECT_LT(forecast[0], full);
  EXPECT_GT(forecast[1], full);
}

// The table of tremie estimate is of the same scene, so that both must say the same of one slump flow: the ends of their
// intervals differ by less than 0.15 of the interval (emulator, table, the quadratures, and the error of the cells, which calibrate
// adds).
TEST(Calibrate, EstimateSaysTheSameOfOneSlumpFlow) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "LAB.toml", measured("590 mm", "2.5 s") + unknown);
  ASSERT_EQ(test::shell("'" TREMIE_PROGRAM "' calibrate LAB.toml --out cal --quiet", folder.path()).code, 0);
  const auto calibrated = nlohmann::json::parse(test::read_file(folder / "cal/summary.json"))["results"];
  const auto printed = test::shell("'" TREMIE_PROGRAM
                                   "' estimate --spread '590 mm' --t500 '2.5 s' --t500-error '0.3 s' --json",
                                   folder.path());
  const auto estimated = nlohmann::json::parse(printed.text)["results"];
  const char* keys[][2] = {{"mix.yield_stress", "yield_stress_Pa"},
                           {"mix.plastic_viscosity", "plastic_viscosity_Pa_s"}};
  for (const auto& [key, name] : keys) {
    const auto& ours = calibrated["parameters"][key]["ci95"];
    const auto& theirs = estimated[name]["ci95"];
    const double width = ours[1].get<double>() - ours[0].get<double>();
    for (const int end : {0, 1})
      EXPECT_NEAR(ours[end].get<double>(), theirs[end].get<double>(), 0.15 * width) << key;
  }
}

TEST(Calibrate, MeasurementsThatContradictEachOtherAreNamed) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "LAB.toml", measured("600 mm", "2 s") + measured("480 mm", "2 s") + unknown);
  const auto result = test::shell("'" TREMIE_PROGRAM "' calibrate LAB.toml --out cal", folder.path());
  EXPECT_EQ(result.code, 3) << result.text;
  EXPECT_NE(result.text.find("standard errors"), std::string::npos) << result.text;
}

// 54 Pa and 35.8 Pa.s spread 537 mm, have 0.6 s to 400 mm and slump 260 mm (a direct run to rest): a slump of 150 mm beside them is the one that
// lies, and the other two do not contradict each other. What it should have been is what it is told to be.
TEST(Calibrate, TheReadingThatTheOthersForecastElsewhereIsNamed) {
  const test::TemporaryFolder folder;
  test::write_file(
      folder / "LAB.toml",
      "[[measured]]\napparatus = \"slump_flow\"\nspread = \"537 mm\"\nspread_error = \"15 mm\"\n"
      "slump = \"150 mm\"\nslump_error = \"10 mm\"\nt400 = \"0.75 s\"\nt400_error = \"0.1 s\"\n" +
          unknown);
  const auto result = test::shell("'" TREMIE_PROGRAM "' calibrate LAB.toml --out cal", folder.path());
  EXPECT_EQ(result.code, 3) << result.text;
  const auto results = nlohmann::json::parse(test::read_file(folder / "cal/summary.json"))["results"];
  bool named = false;
  for (const auto& c : results["contradictions"]) {
    if (c["reading"] != "measured[0].slump") continue;
    named = true;
    EXPECT_NEAR(c["forecast"].get<double>(), 260.0, 6.0);
    EXPECT_GT(c["ci99"][0], 150.0);
  }
  EXPECT_TRUE(named) << results["contradictions"].dump();
}

}  // namespace
}  // namespace tremie
