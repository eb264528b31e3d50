// Keys of the L-box: defaults, faults, the resolved scene.

#include <gtest/gtest.h>

#include "apparatus/l_box/l_box.hpp"
#include "tests/apparatus/complaint.hpp"

namespace tremie::scene {
namespace {

using test::complaint;
using test::says;

const std::string mix_a = "apparatus = \"l_box\"\nmix = \"mix_a\"\n";

l_box::Scene l_box_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return std::any_cast<const l_box::Scene&>(read_text(text, "a.toml", overrides).test);
}

TEST(LBoxScene, DefaultsAreTheStandards) {
  const auto s = l_box_of(mix_a);
  EXPECT_EQ(s.box.column_length, 0.10);
  EXPECT_EQ(s.box.column_height, 0.60);
  EXPECT_EQ(s.box.channel_length, 0.70);
  EXPECT_EQ(s.box.channel_height, 0.15);
  EXPECT_EQ(s.box.width, 0.20);
  EXPECT_EQ(s.rest, 60.0);
  EXPECT_EQ(s.duration, 180.0);
  EXPECT_EQ(s.gate_speed, 0.30);
  EXPECT_EQ(s.bars, 0);
  EXPECT_EQ(s.model.space, SpaceKind::plane);
  EXPECT_EQ(s.model.cell, (std::array{0.01, 0.01}));
  EXPECT_EQ(s.model.points_per_cell, (std::array{16, 4}));
}

// Three dimensions have cells and points of their own, each unless the scene gives it.
TEST(LBoxScene, ThreeDimensionsStartFromLargerCells) {
  const auto s = l_box_of(mix_a, {"model.space=half", "test.bars=2"});
  EXPECT_EQ(s.model.cell, (std::array{0.015, 0.015}));
  EXPECT_EQ(s.model.points_per_cell, (std::array{8, 4}));
  EXPECT_EQ(l_box_of(mix_a, {"model.space=half", "model.cell=20 mm"}).model.cell[0], 0.02);
}

TEST(LBoxScene, WhatASceneSays) {
  const auto s =
      l_box_of(mix_a + "[box]\nwidth = \"15 cm\"\n[test]\nrest = \"4 min\"\ngate_speed = \"instant\"\n",
               {"model.space=plane_with_side_walls"});
  EXPECT_EQ(s.box.width, 0.15);
  EXPECT_EQ(s.rest, 240.0);
  EXPECT_FALSE(s.gate_speed.has_value());
  EXPECT_EQ(s.model.space, SpaceKind::plane_with_side_walls);
}

TEST(LBoxScene, FaultsNameTheKey) {
  EXPECT_TRUE(says(complaint(mix_a + "[test]\nbars = 1\n"), {"bad.toml:4: test.bars", "0, 2", "or 3"}));
  EXPECT_TRUE(says(complaint(mix_a, {"test.bars=4"}), {"test.bars", "at most 3"}));
  EXPECT_TRUE(says(complaint(mix_a, {"test.bars=2"}), {"test.bars", "three dimensions", "\"half\""}));
  EXPECT_EQ(complaint(mix_a, {"test.bars=2", "model.space=half"}), "");
  // Bars of 12 mm stand at least 36 mm apart: 11 diameters for three.
  EXPECT_TRUE(says(complaint(mix_a, {"test.bars=3", "model.space=half", "box.width=130 mm"}),
                   {"box.width", "\"0.132 m\""}));
  EXPECT_EQ(complaint(mix_a, {"test.bars=2", "model.space=half", "box.width=130 mm"}), "");
  EXPECT_TRUE(says(complaint(mix_a, {"test.bars=2", "model.space=half", "model.method=newton"}),
                   {"model.method", "\"auto\""}));
  EXPECT_TRUE(says(complaint(mix_a, {"test.gate_speed=0 m/s"}), {"test.gate_speed", "greater than 0 m/s"}));
  EXPECT_TRUE(says(complaint(mix_a, {"test.lift_speed=1 m/s"}), {"test.lift_speed", "unknown key"}));
  EXPECT_TRUE(
      says(complaint(mix_a, {"model.space=axisymmetric"}), {"model.space", "\"plane_with_side_walls\""}));
  EXPECT_TRUE(says(complaint(mix_a, {"box.channel_height=70 cm"}), {"box.channel_height", "column_height"}));
  EXPECT_TRUE(says(complaint(mix_a, {"model.cell=11 cm"}), {"model.cell", "larger than the column"}));
  EXPECT_TRUE(says(complaint(mix_a, {"model.cell=1e-6 m"}), {"model.cell", "points"}));
  EXPECT_TRUE(says(complaint(mix_a + "[cone]\n"), {"bad.toml:3: cone", "unknown key"}));
  EXPECT_TRUE(says(complaint(mix_a, {"preset=paper"}), {"preset", "unknown key"}));
}

TEST(LBoxScene, WhatHasNoEngineIsAnInputError) {
  const Scene scene = read_text(mix_a, "a.toml", {"model.scheme=explicit", "model.yield=papanastasiou"});
  EXPECT_THROW(estimate(scene), InputError);
  EXPECT_THROW(run(scene), InputError);
}

TEST(LBoxScene, AResolvedSceneReadsBack) {
  const Scene first = read_text(mix_a, "a.toml", {"test.gate_speed=instant", "model.cell=[20 mm, 7 mm]"});
  const Scene second = read_text(first.resolved, "a.toml");
  EXPECT_EQ(read_text(second.resolved, "a.toml").resolved, second.resolved);
  EXPECT_EQ(std::any_cast<const l_box::Scene&>(second.test).model.cell, (std::array{0.02, 0.007}));
}

TEST(LBoxScene, UsesSayWhatIsLeftOut) {
  std::string all;
  for (const auto& line : uses(read_text(mix_a, "a.toml"))) all += line + "\n";
  EXPECT_TRUE(
      says(all, {"side walls: left out", "bars: left out", "flocculation: stored", "gate: a moving"}));
}

}  // namespace
}  // namespace tremie::scene
