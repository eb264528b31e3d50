// Rest is a distance: a slump flow has stopped when its spread would gain less than 0.2 %, however slowly it creeps.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "apparatus/registry/registry.hpp"

namespace tremie {
namespace {

const std::string sticky = R"(apparatus = "slump_flow"
[mix]
yield_stress = "20 Pa"
plastic_viscosity = "100 Pa.s"
density = "2300 kg/m3"
[test]
duration = "20000 s"
[output]
frames = false
)";

scene::Outcome outcome_of(const std::vector<std::string>& overrides) {
  return scene::run(scene::read_text(sticky, "sticky.toml", overrides));
}

double number_of(const scene::Outcome& outcome, const char* name) {
  return scene::find_number(outcome, name).value_or(-1.0);
}

// The spread at rest follows from the yield stress: three viscosities end within 1 % of each other, and of the 690 mm
// that half of the cells tend to. Times go like the viscosity. Runs were called stopped by their
// speed at 666, 647 and 609 mm.
TEST(Rest, TheViscosityDecidesWhenAndNotWhere) {
  double last_time = 0.0;
  for (const char* viscosity : {"100 Pa.s", "300 Pa.s", "1000 Pa.s"}) {
    const auto outcome = outcome_of({std::string("mix.plastic_viscosity=") + viscosity});
    EXPECT_NEAR(number_of(outcome, "spread_mm") / 690.0, 1.0, 0.01) << viscosity;
    EXPECT_GT(number_of(outcome, "stopped_at_s"), 1.8 * last_time) << viscosity;
    EXPECT_LT(outcome.cost.steps, 800) << viscosity;  // in steps of 0.1 s it would be 4,000 to 40,000
    last_time = number_of(outcome, "stopped_at_s");
  }
}

// At one yield stress times go like the viscosity (dimensional analysis, where inertia is small): within 15 %, as 0.2 % of a reach
// that is known to 0.03 % is told to a fifteenth, and the reach nears its end like t^-1 or faster. They scattered by a half.
TEST(Rest, WhenItStoppedIsSmoothInTheViscosity) {
  for (const double viscosity : {50.0, 53.0, 56.0})
    EXPECT_NEAR(
        number_of(outcome_of({fmt::format("mix.plastic_viscosity={} Pa.s", viscosity)}), "stopped_at_s") /
            (5.0 * viscosity),
        1.0, 0.15)
        << viscosity;
}

// Without a yield stress it spreads like t^(1/8) for ever (Huppert 1982).
TEST(Rest, ANewtonianFluidDoesNot) {
  EXPECT_EQ(number_of(outcome_of({"mix.yield_stress=0 Pa", "test.duration=60 s"}), "stopped_at_s"), -1.0);
}

TEST(Rest, ABodyThatDoesNotMoveHasNoSlump) {
  const auto outcome = outcome_of({"mix.yield_stress=5000 Pa"});
  EXPECT_NEAR(number_of(outcome, "slump_mm"), 0.0, 0.5);
  EXPECT_GE(number_of(outcome, "stopped_at_s"), 0.0);
  EXPECT_LT(outcome.cost.simulated, 5.0);
}

// Concrete of 90 kPa.s sets out so slowly that it gains next to nothing in the first half second, and in the next minute a third
// of its height: at 5 Pa its weight is a thousand times what it bears.
TEST(Rest, ABodyThatSetsOutSlowlyIsNotAtRest) {
  const auto outcome = outcome_of({"mix.yield_stress=5 Pa", "mix.plastic_viscosity=90000 Pa.s",
                                   "test.lift_speed=instant", "model.cell=20 mm", "test.duration=5 s"});
  EXPECT_EQ(number_of(outcome, "stopped_at_s"), -1.0);
}

// Within 7 s of a viscous time of 333 s: a low cylinder of 320 kPa.s that weighs six times its yield stress has moved by 0.3 mm.
TEST(Rest, ABodyThatHasHardlySetOutIsNotAtRest) {
  const auto outcome =
      outcome_of({"mix.yield_stress=150 Pa", "mix.plastic_viscosity=320000 Pa.s", "mix.density=1980 kg/m3",
                  "cone.top_radius=35 mm", "cone.bottom_radius=50 mm", "cone.height=50 mm",
                  "test.lift_speed=instant", "test.duration=7 s"});
  EXPECT_EQ(number_of(outcome, "stopped_at_s"), -1.0);
  EXPECT_FALSE(outcome.checks.stood_still);
}

// A low mould, 60 mm wide above and 25 mm below: its rim falls before anything spreads, and lands after 0.108 s.
TEST(Rest, AFallingRimIsNotAtRest) {
  const auto outcome =
      outcome_of({"mix.yield_stress=100 Pa", "mix.plastic_viscosity=1000 Pa.s", "cone.top_radius=60 mm",
                  "cone.bottom_radius=25 mm", "cone.height=10 mm", "test.lift_speed=instant",
                  "model.cell=[\"2 mm\", \"0.5 mm\"]", "test.duration=60 s"});
  EXPECT_GE(number_of(outcome, "stopped_at_s"), 0.1);
}

// A looser tolerance ends the run sooner, at a smaller spread.
TEST(Rest, TheSceneMayChooseItsTolerance) {
  const auto loose = outcome_of({"test.rest_tolerance=0.05"}), close = outcome_of({});
  EXPECT_LT(loose.cost.simulated, 0.7 * close.cost.simulated);
  EXPECT_LT(number_of(loose, "spread_mm"), number_of(close, "spread_mm"));
  EXPECT_GT(number_of(loose, "spread_mm"), 0.90 * number_of(close, "spread_mm"));
  EXPECT_THROW(outcome_of({"test.rest_tolerance=0"}), std::exception);
}

}  // namespace
}  // namespace tremie
