// The J-ring: what its bars take of a slump flow, and what is refused.

#include <gtest/gtest.h>

#include <map>

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

/// A ring of reference_data/rings, run once.
const scene::Outcome& with_ring(const std::string& name) {
  static std::map<std::string, scene::Outcome> runs;
  const auto known = runs.find(name);
  return known != runs.end() ? known->second
                             : runs.emplace(name, run("j_ring", {"ring=" + name})).first->second;
}

// 16 bars of 18 mm cover a third of their circle: they hold some concrete back, and what they hold back stands higher
// inside. The spread without them is the slump flow's of the same scene to the last digit.
TEST(JRing, BarsTakeSpreadAndLeaveAStep) {
  const scene::Outcome &ring = with_ring("en"), plain = run("slump_flow");
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

// EN 206: PJ1 with 12 bars, PJ2 with 16, up to a blocking step of 10 mm; a concrete that stands at the centre has none.
TEST(JRing, EnClassesTheStep) {
  const auto class_of = [](const scene::Outcome& outcome) {
    return *scene::find_result(outcome, "class_en206_pj");
  };
  const auto is = [&](const scene::Outcome& outcome, const char* name) {
    if (result(outcome, "step_mm") < 10.5)
      EXPECT_EQ(std::get<std::string>(class_of(outcome)), name);
    else
      EXPECT_TRUE(std::holds_alternative<std::monostate>(class_of(outcome)));
  };
  is(with_ring("en"), "PJ2"), is(with_ring("en_wide"), "PJ1");
  EXPECT_LT(result(with_ring("en_wide"), "step_mm"), result(with_ring("en"), "step_mm"));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(class_of(with_ring("astm"))));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(class_of(run("j_ring", {"mix.yield_stress=3 kPa"}))));
}

// Limits of 25 and 50 mm, for its own ring alone.
TEST(JRing, AstmAssessesTheSpreadThatIsLost) {
  const auto word = [](const scene::Outcome& outcome) {
    return *scene::find_result(outcome, "blocking_astm_c1621");
  };
  EXPECT_TRUE(std::holds_alternative<std::monostate>(word(with_ring("en"))));
  const double lost = result(with_ring("astm"), "spread_lost_mm");
  EXPECT_EQ(std::get<std::string>(word(with_ring("astm"))), lost <= 25.0 ? "no visible blocking"
                                                            : lost <= 50.0
                                                                ? "minimal to noticeable blocking"
                                                                : "noticeable to extreme blocking");
  EXPECT_EQ(std::get<std::string>(word(run("j_ring", {"ring=astm", "mix.yield_stress=3 kPa"}))),
            "no visible blocking");
  EXPECT_THROW(run("j_ring", {"ring=uk"}), scene::InputError);
}

// The defaults are en.toml's. Thinner rods leave wider gaps: ASTM's ring takes less than the narrow one of EN 12350-12, and
// the wide one of EN 12350-12 less still (35, 32 and 17 mm measured).
TEST(JRing, WiderGapsTakeLess) {
  const auto lost = [](const char* ring) { return result(with_ring(ring), "spread_lost_mm"); };
  EXPECT_LT(lost("astm"), lost("en"));
  EXPECT_LT(lost("en_wide"), lost("astm"));
}

TEST(JRing, RefusesBarsThatCannotStand) {
  for (const char* set : {"ring.bars=14", "ring.diameter=210 mm", "ring.bar_diameter=60 mm",
                          "model.scheme=explicit", "model.space=axisymmetric"})
    EXPECT_THROW(run("j_ring", {set}), scene::InputError) << set;
}

}  // namespace
}  // namespace tremie
