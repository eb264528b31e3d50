// What an L-box is marked for: cells that do not resolve its concrete, bars in a fast flow. When it stands.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "apparatus/l_box/l_box.hpp"
#include "apparatus/parts/bars.hpp"
#include "apparatus/parts/boxes/checks.hpp"
#include "apparatus/parts/boxes/reading.hpp"
#include "apparatus/registry/registry.hpp"

namespace tremie {
namespace {

const std::string plane = R"(apparatus = "l_box"
[mix]
yield_stress = "50 Pa"
plastic_viscosity = "30 Pa.s"
[test]
duration = "20 s"
[output]
frames = false
)";

std::vector<std::string> reasons(const std::string& cell, const std::string& duration = "20 s") {
  return scene::run(
             scene::read_text(plane, "plane.toml", {"model.cell=" + cell, "test.duration=" + duration}))
      .checks.reasons;
}

// The concrete stands 82 mm deep behind the gate: 1.6 cells of 50 mm, whose ratio is 1.02 where 0.75 is right. On cells of 50 mm
// along the channel it never reaches the end. On 20 mm the ratio at rest is 6 % off.
TEST(LBoxChecks, CellsThatDoNotResolveTheDepthAreMarked) {
  EXPECT_TRUE(reasons("15 mm").empty());
  for (const char* cell : {"20 mm", "50 mm", "100 mm", "[\"50 mm\", \"20 mm\"]", "[\"20 mm\", \"50 mm\"]"})
    EXPECT_FALSE(reasons(cell).empty()) << cell;
}

// Walls 100 mm apart carry half of the weight of 600 Pa: H1 is 285 mm on the default cells and 268 on half of them. At 400 Pa they
// carry a third.
TEST(LBoxChecks, AColumnThatItsWallsNearlyCarryIsMarked) {
  const auto reasons_of = [](const std::string& yield_stress, const std::string& cell) {
    const auto overrides = {"mix.yield_stress=" + yield_stress, "model.cell=" + cell,
                            std::string("test.duration=4 s")};
    return scene::run(scene::read_text(plane, "plane.toml", overrides)).checks.reasons;
  };
  ASSERT_EQ(reasons_of("600 Pa", "10 mm").size(), 1u);
  EXPECT_NE(reasons_of("600 Pa", "10 mm").front().find("walls carry 0.51"), std::string::npos);
  EXPECT_TRUE(reasons_of("400 Pa", "10 mm").empty());
}

// 11.8 Pa, 131 Pa.s read after 3 s: H1 is 152 mm on cells of 16 mm, 136 on 10 mm and 128 on 4 mm, and falls by a fifth in the last
// tenth of the time. 162 Pa after 10 s: 106 mm on 26 mm cells, 99 on half of them.
TEST(LBoxChecks, ACoarseColumnThatEmptiesIsMarked) {
  const auto reasons_of = [](const std::vector<std::string>& overrides) {
    return scene::run(scene::read_text(plane, "plane.toml", overrides)).checks.reasons;
  };
  const auto has = [](const std::vector<std::string>& reasons, const char* words) {
    return std::any_of(reasons.begin(), reasons.end(),
                       [&](const std::string& r) { return r.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(has(reasons_of({"mix.yield_stress=11.8 Pa", "mix.plastic_viscosity=131 Pa.s",
                              "test.duration=3 s", "test.gate_speed=0.14 m/s", "model.cell=15 mm"}),
                  "over the last tenth of the time"));
  EXPECT_TRUE(
      has(reasons_of({"mix.yield_stress=162 Pa", "mix.plastic_viscosity=34 Pa.s", "test.duration=10 s",
                      "test.gate_speed=0.076 m/s", "model.cell=[\"25.7 mm\", \"17.5 mm\"]"}),
          "3.9 cells long"));
}

// A gate that does not open lets nothing through in a minute, on the default cells and on coarser ones, above a floor that holds
// and above one without friction.
TEST(LBoxChecks, NothingPassesAShutGate) {
  for (const char* cell : {"25 mm", "10 mm"})
    for (const char* walls : {"no_slip", "free_slip"}) {
      const auto outcome = scene::run(
          scene::read_text(plane, "plane.toml",
                           {std::string("model.cell=") + cell, std::string("walls.contact=") + walls,
                            "test.duration=60 s", "test.gate_speed=1e-9 m/s"}));
      EXPECT_EQ(scene::find_number(outcome, "volume_in_channel_m3"), 0.0) << cell << walls;
      EXPECT_NEAR(*scene::find_number(outcome, "h1_mm"), 600.0, 0.6) << cell << walls;
      EXPECT_TRUE(outcome.checks.reasons.empty()) << cell << walls;
    }
}

// Any box has a face of the grid where its gate stands, within a hundredth of the column.
TEST(LBoxChecks, TheGateStandsOnAFaceOfTheGrid) {
  for (const auto& [column, channel] : {std::pair{0.1, 0.7}, {0.097, 0.713}, {0.12, 0.55}})
    for (double cell : {0.025, 0.015, 0.0125, 0.01, 0.00625, 0.005}) {
      const Axis axis = boxes::along_the_channel({.column_length = column, .channel_length = channel}, cell);
      EXPECT_NEAR(axis.length(), column + channel, 1e-12);
      EXPECT_NEAR(axis.h / cell, 1.0, 0.3) << cell;
      EXPECT_NEAR(boxes::place_of_gate(axis) / column, 1.0, 0.01) << column << " " << cell;
    }
}

// 1 of 4 points crosses half a metre up, while the opening reaches up to 0.15 m: a quarter went through. One that comes out
// below it did not.
TEST(LBoxChecks, WhatCrossesTheWallAboveTheOpeningIsCounted) {
  Body<PlaneStrain> body;
  body.grid.axes[0] = boxes::along_the_channel({}, 0.01);
  body.grid.axes[1] = {.h = 0.01};
  for (double y : {0.5, 0.3, 0.1, 0.05}) add_point<2>(body.points, {0.099, y}, 1.0, 1e-4, 0.0);
  const auto from = body.points.x;
  body.points.x[0][0] = body.points.x[3][0] = 0.101;
  EXPECT_NEAR(boxes::share_through_the_wall(body, from, 0.15), 0.25, 1e-12);
}

// A thousandth through the wall is nothing, three thousandths are a leak.
TEST(LBoxChecks, ConcreteThatGoesThroughTheWallIsMarked) {
  for (const auto& [through, marked] : {std::pair{0.003, true}, {0.001, false}}) {
    l_box::Outcome outcome;
    outcome.series.resize(2);
    outcome.series.back().through_the_wall = through;
    EXPECT_EQ(!boxes::went_through_the_wall({{}, outcome}).empty(), marked) << through;
  }
}

// While the column is high nothing is thin.
TEST(LBoxChecks, AHighColumnIsNotThin) { EXPECT_TRUE(reasons("25 mm", "0.3 s").empty()); }

// A run that is stopped speaks neither of the test's end nor of a passing ratio as its result.
TEST(LBoxChecks, AnInterruptedRunSpeaksOfSoFar) {
  const std::atomic<bool> stop = true;
  scene::Observer observer;
  observer.interrupted = &stop;
  const auto outcome = scene::run(scene::read_text(plane, "plane.toml", {"model.cell=20 mm"}), observer);
  ASSERT_EQ(outcome.status, Status::interrupted);
  std::string lines;
  for (const auto& line : outcome.lines) lines += line + "\n";
  EXPECT_EQ(lines.find("test.duration"), std::string::npos) << lines;
  EXPECT_EQ(lines.find("never"), std::string::npos) << lines;
  EXPECT_NE(lines.find("not yet when the run was interrupted"), std::string::npos) << lines;
  EXPECT_NE(lines.find("passing ratio   none yet"), std::string::npos) << lines;
}

/// A line a second in which H1 falls by `fall` each [m] and H2 is half of it.
std::vector<l_box::Sample> sinking(int seconds, double fall) {
  std::vector<l_box::Sample> series;
  for (int t = 0; t <= seconds; ++t) {
    l_box::Sample s;
    s.time = t, s.front = 0.7, s.h1 = 0.1 - fall * t, s.h2 = 0.5 * s.h1;
    series.push_back(s);
  }
  return series;
}

// 0.9 mm in 30 s is less than the millimetre that a rule shows, 1.2 mm is more; and 30 s must have gone by.
TEST(LBoxStands, WhereItsDepthsKeepForHalfAMinute) {
  EXPECT_FALSE(boxes::stands_since(sinking(29, 0.0)));
  EXPECT_EQ(boxes::stands_since(sinking(40, 3e-5)), 10.0);
  EXPECT_FALSE(boxes::stands_since(sinking(40, 4e-5)));
  auto arrives = sinking(40, 0.0);
  for (int t = 0; t < 20; ++t) arrives[t].h2.reset();
  EXPECT_FALSE(boxes::stands_since(arrives));
}

// H2/H1 from 0.5 at 10 s to 0.56 at 40 s: 0.12 a minute.
TEST(LBoxStands, RatioChangesByTheMinute) {
  auto series = sinking(40, 0.0);
  series.back().h2 = 0.56 * series.back().h1;
  EXPECT_NEAR(*boxes::ratio_change(series) * 60.0, 0.12, 1e-12);
  EXPECT_FALSE(boxes::ratio_change(sinking(20, 0.0)));
}

// In a box without side walls F(h) = h^2/2 falls by tau_0 L/rho g: from 80 mm to 60 mm over 0.7 m at 47.1 Pa. The drop at
// the mean depth is the same.
TEST(LBoxChecks, DropOfABedAtRestIsTheThinLayersOne) {
  l_box::Scene scene;
  scene.box.width = 1e9, scene.mix.density = 2400.0;
  scene.mix.tau_0 = 0.5 * (0.08 * 0.08 - 0.06 * 0.06) / 0.7 * 2400.0 * 9.81;
  EXPECT_NEAR(l_box::drop_at_rest(scene, 0.07, 0.7), 0.02, 1e-9);
  scene.box.width = 0.14;  // half the bed's depth on each side again
  EXPECT_NEAR(l_box::drop_at_rest(scene, 0.07, 0.7), 0.04, 1e-9);
}

// rho U D / (mu + tau_0 D/U) = 2000 . 0.5 . 0.012 / (1 + 0.012 . 25 / 0.5) = 7.5.
TEST(LBoxChecks, ReynoldsNumberOfTheBarsIsThatOfTheFastestFront) {
  l_box::Scene scene;
  scene.mix.density = 2000.0, scene.mix.mu = 1.0, scene.mix.tau_0 = 25.0;
  auto series = sinking(2, 0.0);
  series[0].front = 0.0, series[1].front = 0.2;
  const auto reynolds = [&](const std::vector<l_box::Sample>& of) {
    return parts::bar_reynolds(scene.mix, scene.model.law, boxes::fastest_front(of), scene.box.bar_diameter);
  };
  EXPECT_NEAR(reynolds(series), 7.5, 1e-12);
  EXPECT_EQ(reynolds(sinking(2, 0.0)), 0.0);
}

}  // namespace
}  // namespace tremie
