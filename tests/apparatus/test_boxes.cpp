// The U-box: against closed forms, and what is refused and marked.

#include <gtest/gtest.h>

#include <cstdio>

#include "apparatus/parts/gated_box/gated_box.hpp"
#include "apparatus/registry/registry.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie {
namespace {

const std::string u_box = R"(apparatus = "u_box"
[mix]
yield_stress = "50 Pa"
plastic_viscosity = "30 Pa.s"
density = "2350 kg/m3"
[model]
cell = "20 mm"
[test]
duration = "300 s"
[output]
frames = false
)";

scene::Outcome run(const std::string& text, const std::vector<std::string>& overrides) {
  return scene::run(scene::read_text(text, "box.toml", overrides));
}
double number(const scene::Outcome& outcome, const char* name) {
  return scene::find_number(outcome, name).value();
}

// Half of 680 mm on both sides: within 5 mm, which is the scatter of a compartment's fill (0.8 % measured); the films that
// drain leave less than 1 % on the walls.
TEST(UBox, AFluidWithoutYieldStressLevels) {
  const auto outcome = run(u_box, {"mix.yield_stress=0 Pa", "test.duration=100 s"});
  EXPECT_NEAR(number(outcome, "rise_mm"), 340.0, 5.0);
  EXPECT_NEAR(number(outcome, "height_difference_mm"), 0.0, 5.0);
  EXPECT_TRUE(outcome.checks.reasons.empty());
}

// Concrete that is about to move up a shaft of length L and width W bears tau_0 (2/L + 2/W) more than its weight. What the
// turn under the wall holds is the same in a taller box, whose path through the shafts is longer: the difference of their
// height differences is that of the paths times tau_0/(rho g) (2/L + 2/W), when the gate opens so slowly that no momentum
// matters. 20.9 mm, within 15 % or 3 mm, half a per cent of the heights (1.6 mm measured).
TEST(UBox, TheWallsHoldTheirYieldStress) {
  const auto box = run(u_box, {"test.gate_speed=5 mm/s"});
  const auto taller = run(u_box, {"test.gate_speed=5 mm/s", "box.height=1080 mm"});
  const auto path = [](const scene::Outcome& o) { return number(o, "h1_mm") + number(o, "rise_mm"); };
  const double l = 50.0 / (2350.0 * gravity);
  const double held = l * (2.0 / 0.14 + 2.0 / 0.2) * (path(taller) - path(box));
  const double more = number(taller, "height_difference_mm") - number(box, "height_difference_mm");
  std::printf("%.1f mm more, closed form %.1f mm\n", more, held);
  EXPECT_NEAR(more / held, 1.0, 0.15);
  for (const auto* o : {&box, &taller}) {
    EXPECT_TRUE(scene::find_number(*o, "stopped_at_s"));
    EXPECT_TRUE(o->checks.reasons.empty());
  }
}

TEST(UBox, TheDefaultsAreThoseOfItsFile) {
  const auto box = [](const std::vector<std::string>& set) {
    return std::any_cast<const gated_box::Scene&>(scene::read_text(u_box, "a.toml", set).test).box;
  };
  const gated_box::Box own = box({}), file = box({"box=u_box"});
  EXPECT_EQ(own.column_length, file.column_length);
  EXPECT_EQ(own.column_height, file.column_height);
  EXPECT_EQ(own.channel_length, file.channel_length);
  EXPECT_EQ(own.channel_height, file.channel_height);
  EXPECT_EQ(own.width, file.width);
}

// Four cells to a compartment make the filling height 4 % too large.
TEST(UBox, CellsThatAreTooLargeForACompartmentAreMarked) {
  const auto outcome = run(u_box, {"model.cell=35 mm", "test.duration=1 s"});
  ASSERT_EQ(outcome.checks.reasons.size(), 1u);
  EXPECT_NE(outcome.checks.reasons[0].find("4 cells long"), std::string::npos) << outcome.checks.reasons[0];
}

TEST(UBox, RefusesWhatItCannotCompute) {
  for (const char* set : {"box.opening=700 mm", "box.compartment=10 mm", "model.scheme=explicit",
                          "model.space=half", "box.column_length=1 m", "test.bars=3"})
    EXPECT_THROW(run(u_box, {set}), scene::InputError) << set;
}

}  // namespace
}  // namespace tremie
