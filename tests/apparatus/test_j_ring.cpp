// The J-ring: what its bars take of a slump flow, and what is refused.

#include <gtest/gtest.h>

#include "apparatus/registry/registry.hpp"

namespace tremie {
namespace {

// Coarse cells: what is asked here does not hang on them.
constexpr const char* mix = R"(
[mix]
yield_stress = "30 Pa"
plastic_viscosity = "20 Pa.s"
[test]
duration = "0.5 s"
[model]
space = "quarter"
cell = ["25 mm", "12.5 mm"]
[output]
frames = false
)";

scene::Outcome run(const std::string& apparatus, const std::vector<std::string>& overrides = {}) {
  return scene::run(scene::read_text("apparatus = \"" + apparatus + "\"\n" + mix, "ring.toml", overrides));
}

double result(const scene::Outcome& outcome, const char* name) {
  return std::get<double>(*scene::find_result(outcome, name));
}

// 16 bars of 18 mm cover a third of their circle: they hold some concrete back, and what they hold back stands higher
// inside. The spread without them is the slump flow's of the same scene to the last digit.
TEST(JRing, BarsTakeSpreadAndLeaveAStep) {
  const scene::Outcome ring = run("j_ring"), plain = run("slump_flow");
  EXPECT_GT(result(ring, "spread_lost_mm"), 2.0);
  EXPECT_LT(result(ring, "spread_lost_mm"), 100.0);
  EXPECT_DOUBLE_EQ(result(ring, "spread_mm") + result(ring, "spread_lost_mm"), result(plain, "spread_mm"));
  EXPECT_GT(result(ring, "step_mm"), 0.0);
}

// Concrete of 3 kPa stands within the ring (the bars begin at 282 mm): nothing is lost.
TEST(JRing, TakesNothingFromConcreteThatDoesNotReachIt) {
  const scene::Outcome stiff = run("j_ring", {"mix.yield_stress=3 kPa"});
  ASSERT_LT(result(stiff, "spread_mm"), 282.0);
  EXPECT_EQ(result(stiff, "spread_lost_mm"), 0.0);
}

TEST(JRing, RefusesBarsThatCannotStand) {
  for (const char* set : {"ring.bars=14", "ring.diameter=210 mm", "ring.bar_diameter=60 mm",
                          "model.scheme=explicit", "model.space=axisymmetric"})
    EXPECT_THROW(run("j_ring", {set}), scene::InputError) << set;
}

}  // namespace
}  // namespace tremie
