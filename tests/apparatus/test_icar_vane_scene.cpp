// Keys of the vane: two protocols that exclude each other, defaults that follow the space, faults.

#include <gtest/gtest.h>

#include <numbers>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/registry/registry.hpp"
#include "tests/apparatus/complaint.hpp"

namespace tremie::scene {
namespace {

using test::complaint;
using test::says;

const std::string mix_a = "apparatus = \"icar_vane\"\nmix = \"mix_a\"\n";
const std::string curve = mix_a + "[test]\nspeeds = [\"0.3 rev/s\", \"0.1 rev/s\"]\n";

icar_vane::Scene vane_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return std::any_cast<const icar_vane::Scene&>(read_text(text, "a.toml", overrides).test);
}

TEST(IcarVaneScene, DefaultsAreTheInstruments) {
  const auto s = vane_of(mix_a);
  EXPECT_EQ(s.vane.radius, 0.0635);
  EXPECT_EQ(s.vane.height, 0.127);
  EXPECT_EQ(s.vane.container_radius, 0.143);
  EXPECT_EQ(s.vane.blades, 4);
  EXPECT_EQ(s.speed, 0.25);
  EXPECT_EQ(s.duration, 20.0);
  EXPECT_TRUE(s.speeds.empty());
  EXPECT_EQ(s.rest, 0.0);
  EXPECT_EQ(s.model.space, SpaceKind::couette);
  EXPECT_EQ(s.model.cell, (std::array{0.001, 0.001}));
  EXPECT_EQ(s.model.points_per_cell, (std::array{3, 3}));
}

TEST(IcarVaneScene, TheCellFollowsTheSpace) {
  EXPECT_EQ(vane_of(mix_a, {"model.space=plane"}).model.cell, (std::array{0.005, 0.005}));
  EXPECT_EQ(vane_of(mix_a, {"model.space=plane", "model.cell=4 mm"}).model.cell, (std::array{0.004, 0.004}));
}

TEST(IcarVaneScene, SpeedsInAnyUnit) {
  EXPECT_DOUBLE_EQ(vane_of(mix_a, {"test.speed=15 rpm"}).speed, 0.25);
  EXPECT_EQ(vane_of(mix_a, {"test.speed=-0.25 rev/s"}).speed, -0.25);
  EXPECT_DOUBLE_EQ(vane_of(mix_a, {"test.speed=1 rad/s"}).speed, 0.5 / std::numbers::pi);
  EXPECT_DOUBLE_EQ(vane_of(mix_a, {"test.orientation=22.5 deg"}).orientation, std::numbers::pi / 8.0);
}

TEST(IcarVaneScene, AFlowCurveHasItsOwnSchedule) {
  const auto s = vane_of(curve);
  EXPECT_EQ(s.speeds, (std::vector{0.3, 0.1}));
  EXPECT_EQ(s.pre_shear_speed, 0.5);
  EXPECT_EQ(s.pre_shear_time, 20.0);
  EXPECT_EQ(s.hold_time, 5.0);
  EXPECT_EQ(s.average_time, 2.0);
  EXPECT_EQ(vane_of(curve + "pre_shear_time = \"0 s\"\n").pre_shear_time, 0.0);
}

// Steps as long as the torques' means read each torque while the concrete is still being accelerated: 212 Pa for 54 Pa.
TEST(IcarVaneScene, ACurveWhoseStepsAreAsLongAsItsMeansIsMarked) {
  const auto outcome = scene::run(scene::read_text(
      curve, "a.toml",
      {"model.time_step=2 s", "model.cell=8 mm", "test.pre_shear_time=0 s", "test.hold_time=2 s"}));
  bool marked = false;
  for (const auto& reason : outcome.checks.reasons)
    marked = marked || reason.find("test.average_time") != std::string::npos;
  EXPECT_TRUE(marked);
}

// A small vane in 19 kPa of hardly any viscosity shears a layer that is thinner than a cell: its torque is that of a larger
// cylinder, 2 pi r^2 h tau_0 = 15.1 mN m and 7 % more.
TEST(IcarVaneScene, ACurveWhoseLayerIsThinnerThanACellIsMarked) {
  const auto outcome =
      run(read_text("apparatus = \"icar_vane\"\n[mix]\nyield_stress = \"19.3 kPa\"\nplastic_viscosity = "
                    "\"0.2 Pa.s\"\n[vane]\nradius = \"5 mm\"\n"
                    "container_radius = \"16 mm\"\nheight = \"5 mm\"\nshaft_radius = \"1 "
                    "mm\"\nblade_thickness = \"0.2 mm\"\n[test]\n"
                    "speeds = [\"1 rev/s\", \"0.3 rev/s\"]\nhold_time = \"2 s\"\npre_shear_time = \"2 "
                    "s\"\npre_shear_speed = \"1 rev/s\"\n[model]\ncell = \"0.6 mm\"\n",
                    "a.toml"));
  ASSERT_FALSE(outcome.checks.reasons.empty());
  EXPECT_NE(outcome.checks.reasons.front().find("do not resolve its sheared layer"), std::string::npos);
}

// Fresh Mix A at 0.25 rev/s, reached in a tenth of a second: a ring of concrete is accelerated with the vane, and the peak is
// not that of structure.
TEST(IcarVaneScene, InertiasPartOfThePeakIsTold) {
  const auto outcome = run(read_text(mix_a, "a.toml", {"test.duration=2 s"}));
  const double peak = *find_number(outcome, "torque_peak_N_m"),
               inertia = *find_number(outcome, "torque_peak_inertia_N_m");
  EXPECT_GT(inertia / peak, 0.2);
  EXPECT_LT(inertia / peak, 0.4);
  EXPECT_LT(peak - inertia, *find_number(outcome, "torque_end_N_m"));
}

// A speed whose shear rates the solver takes for rest has no torque, though the closed form has its yield stress.
TEST(IcarVaneScene, ATorqueThatIsTooSmallIsMarkedAtAnyTime) {
  const auto outcome = run(
      read_text(mix_a, "a.toml", {"mix.thixotropy=false", "test.speed=2e-5 rev/s", "test.duration=0.7 s"}));
  const bool small =
      *find_number(outcome, "torque_end_N_m") < 0.9 * *find_number(outcome, "torque_couette_reference_N_m");
  EXPECT_EQ(small, !outcome.checks.reasons.empty());
}

TEST(IcarVaneScene, OneProtocolOrTheOther) {
  EXPECT_TRUE(says(complaint(curve + "duration = \"3 s\"\n"), {"bad.toml:5: test.duration", "test.speeds"}));
  EXPECT_TRUE(says(complaint(mix_a + "[test]\nhold_time = \"3 s\"\n"),
                   {"bad.toml:4: test.hold_time", "test.speeds"}));
  EXPECT_TRUE(vane_of(curve, {"test.speed=0.2 rev/s"}).speeds.empty());  // the later layer wins
  const std::string constant = mix_a + "[test]\nspeed = \"0.2 rev/s\"\n";
  EXPECT_EQ(vane_of(constant, {"test.speeds=[\"1 rpm\"]"}).speeds.size(), 1U);
  EXPECT_EQ(read_text(constant, "a.toml", {"test.speeds=[\"1 rpm\"]"}).notes.size(), 1U);
}

TEST(IcarVaneScene, FaultsNameTheKey) {
  EXPECT_TRUE(says(complaint(mix_a, {"test.speed=0 rpm"}), {"test.speed", "would not turn"}));
  EXPECT_TRUE(
      says(complaint(mix_a + "[test]\nspeed = 0.25\n"), {"bad.toml:4: test.speed", "rev/s", "bare number"}));
  EXPECT_TRUE(says(complaint(curve, {"test.average_time=6 s"}), {"test.average_time", "hold_time"}));
  EXPECT_TRUE(says(complaint(curve, {"test.hold_time=0 s"}), {"test.hold_time"}));
  EXPECT_TRUE(says(complaint(mix_a, {"test.speeds=[\"-1 rpm\"]"}), {"test.speeds", "greater than 0 rad/s"}));
  EXPECT_TRUE(says(complaint(mix_a, {"vane.radius=15 cm"}), {"vane.container_radius", "vane.radius"}));
  EXPECT_TRUE(says(complaint(mix_a, {"vane.blades=1"}), {"vane.blades", "at least 2"}));
  EXPECT_TRUE(says(complaint(mix_a, {"vane.blade_thickness=10 cm"}), {"vane.blade_thickness"}));
  EXPECT_TRUE(says(complaint(mix_a, {"model.cell=10 cm"}), {"model.cell", "gap"}));
  EXPECT_TRUE(says(complaint(mix_a, {"model.space=full"}), {"model.space", "\"couette\", \"plane\""}));
}

const std::string slides =
    mix_a +
    "[walls]\ncontact = \"interface\"\ninterface_yield_stress = \"27 Pa\"\ninterface_viscosity = "
    "\"300 Pa.s/m\"\n";

TEST(IcarVaneScene, WallsHoldOrSlide) {
  EXPECT_TRUE(std::holds_alternative<NoSlip>(vane_of(mix_a).walls));
  for (const char* space : {"couette", "plane"}) {
    const auto s = vane_of(slides, {std::string("model.space=") + space});
    EXPECT_EQ(std::get<Interface>(s.walls).tau_i, 27.0);
    EXPECT_EQ(std::get<Interface>(s.walls).k_i, 300.0);
    EXPECT_EQ(container_face(s), FaceKind::wall_law);
    EXPECT_EQ(cylinder_face(s), FaceKind::no_slip);
  }
  const auto tribometer = vane_of(slides, {"walls.surface=cylinder"});
  EXPECT_EQ(container_face(tribometer), FaceKind::no_slip);
  EXPECT_EQ(cylinder_face(tribometer), FaceKind::wall_law);
  EXPECT_TRUE(std::holds_alternative<Interface>(
      vane_of(slides, {"model.space=cylindrical", "mix.thixotropy=false"}).walls));
}

TEST(IcarVaneScene, WallsThatCannotBeAreRefused) {
  EXPECT_TRUE(says(complaint(slides, {"walls.surface=cylinder", "model.space=plane"}),
                   {"walls.surface", "blades", "\"couette\""}));
  EXPECT_TRUE(
      says(complaint(slides, {"walls.interface_yield_stress=0 Pa", "walls.interface_viscosity=0 Pa.s/m"}),
           {"walls.interface_viscosity", "no torque"}));
  EXPECT_TRUE(
      says(complaint(slides, {"walls.contact=free_slip"}), {"walls.contact", "\"no_slip\", \"interface\""}));
  EXPECT_TRUE(says(complaint(slides, {"walls.contact=friction"}), {"walls.contact"}));
}

TEST(IcarVaneScene, AResolvedSceneReadsBack) {
  for (const auto& text : {mix_a, curve, slides}) {
    const Scene first = read_text(text, "a.toml", {"model.space=plane"});
    const Scene second = read_text(first.resolved, "a.toml");
    EXPECT_EQ(read_text(second.resolved, "a.toml").resolved, second.resolved);
    EXPECT_EQ(std::any_cast<const icar_vane::Scene&>(first.test).speeds,
              std::any_cast<const icar_vane::Scene&>(second.test).speeds);
    EXPECT_EQ(std::any_cast<const icar_vane::Scene&>(second.test).model.cell, (std::array{0.005, 0.005}));
  }
}

}  // namespace
}  // namespace tremie::scene
