// A row of an apparatus' table stands in every place that tells its reading; nested names; passing times.

#include <gtest/gtest.h>

#include <algorithm>

#include "apparatus/common/readings.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/run_files/glossary.hpp"
#include "apparatus/run/passing.hpp"

namespace tremie {
namespace {

scene::Outcome coarse_slump() {
  return scene::run(
      scene::read_text("apparatus = \"slump_flow\"\nmix = \"mix_a\"\n[model]\ncell = \"30 mm\"\n"
                       "[test]\nduration = \"1 s\"\n[output]\nframes = false\n",
                       "slump.toml"));
}

bool has_line(const scene::Outcome& outcome, const std::string& start) {
  return std::any_of(outcome.lines.begin(), outcome.lines.end(),
                     [&](const std::string& line) { return line.starts_with(start); });
}

// Slump is the cone's 300 mm less the height, at the end and in every line of the series.
TEST(Readings, SlumpAndTimeTo400StandInResultsSeriesScreenAndGlossary) {
  const scene::Outcome outcome = coarse_slump();
  const auto result = [&](const char* name) { return std::get<double>(*scene::find_result(outcome, name)); };
  EXPECT_DOUBLE_EQ(result("slump_mm"), 300.0 - result("height_mm"));
  EXPECT_GT(result("t400_s"), 0.0);
  EXPECT_LT(result("t400_s"), 1.0);
  const auto column = [&](const std::string& name) {
    return std::find_if(outcome.series.begin(), outcome.series.end(),
                        [&](const auto& c) { return c.name == name; });
  };
  ASSERT_NE(column("slump_mm"), outcome.series.end());
  EXPECT_DOUBLE_EQ(column("slump_mm")->values.back(), result("slump_mm"));
  EXPECT_EQ(column("t400_s"), outcome.series.end());
  EXPECT_TRUE(has_line(outcome, "slump ") && has_line(outcome, "t400 "));
  EXPECT_EQ(report::words_of("t400_s", "slump_flow"), "t400, time to a diameter of 400 mm");
  EXPECT_EQ(report::words_of("t400_s", "l_box"), "t400, front 400 mm from the gate");
}

// What a unit takes off a name is its own ending, not as many letters as the unit has.
TEST(Readings, ANameWithoutItsUnit) {
  EXPECT_EQ(scene::name_without_unit("spread_mm"), "spread");
  EXPECT_EQ(scene::name_without_unit("slip_end_m_per_s"), "slip_end");
  EXPECT_EQ(scene::name_without_unit("hysteresis_area_Pa_per_s"), "hysteresis_area");
  EXPECT_EQ(scene::name_without_unit("emptied"), "emptied");
}

TEST(Readings, DottedNamesNestAndAGroupWithoutARowIsNull) {
  std::vector<scene::Result> results;
  scene::put_empty_group("measured.spread_mm", results);
  scene::put_result("input.alpha", 0.5, results);
  scene::put_result("input.K_Pa", 2.0, results);
  scene::put_empty_group("input.none", results);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(results[0].value));
  const auto& input = std::get<std::vector<scene::Result>>(results[1].value);
  ASSERT_EQ(input.size(), 2u);
  EXPECT_EQ(input[1].name, "K_Pa");
  scene::put_result("measured.spread_mm", 590.0, results);
  EXPECT_EQ(std::get<std::vector<scene::Result>>(results[0].value).front().name, "spread_mm");
}

// From 1 at 2 s to 3 at 3 s: 1.5 is passed at 2.25 s. What begins beyond a value has passed it at its start.
TEST(Readings, ATimeOfPassingLiesOnTheLineBetweenTwoReadings) {
  struct Line {
    double time, reading;
  };
  const std::vector<Line> series{{0.0, 0.0}, {2.0, 1.0}, {3.0, 3.0}, {4.0, 2.0}};
  EXPECT_EQ(experiment::time_of_passing(series, &Line::reading, 1.5), 2.25);
  EXPECT_EQ(experiment::time_of_passing(series, &Line::reading, -1.0), 0.0);
  EXPECT_FALSE(experiment::time_of_passing(series, &Line::reading, 3.5));
}

}  // namespace
}  // namespace tremie
