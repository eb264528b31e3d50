// What a slump flow is marked for: cells and volumes that cannot be trusted.

#include <gtest/gtest.h>

#include <algorithm>

#include "apparatus/parts/cone/checks.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/run/energy_watch.hpp"
#include "apparatus/run/run_checks.hpp"

namespace tremie {
namespace {

const std::string thin = R"(apparatus = "slump_flow"
[mix]
yield_stress = "20 Pa"
plastic_viscosity = "35.8 Pa.s"
[test]
duration = "5 s"
lift_speed = "instant"
[output]
frames = false
)";

bool marked_as(const char* what, const std::vector<std::string>& overrides) {
  const auto outcome = scene::run(scene::read_text(thin, "thin.toml", overrides));
  for (const auto& reason : outcome.checks.reasons)
    if (reason.find(what) != std::string::npos) return true;
  return false;
}

bool marked_as_thin(const std::vector<std::string>& overrides) {
  return marked_as("thinner than", overrides);
}

// After 5 s this body is 18 to 30 mm thick, whatever the scheme: one cell of 40 mm cannot shear, three of 10
// mm can.
TEST(SlumpFlowChecks, ABodyThinnerThanACellIsMarked) {
  EXPECT_TRUE(marked_as_thin({"model.cell=40 mm"}));
  EXPECT_TRUE(marked_as_thin({"model.cell=40 mm", "model.scheme=explicit", "model.yield=papanastasiou"}));
  EXPECT_FALSE(marked_as_thin({"model.cell=10 mm"}));
}

// In three dimensions a body of 1.3 cells spreads 6.3 % too far (three_d.md); in a section it is within 5.3 %.
// With one point a cell the outline had gaps, and a spread less than the mould's foot was read.
TEST(SlumpFlowChecks, OnePointACellIsMarked) {
  EXPECT_TRUE(
      marked_as("one point a cell", {"model.cell=20 mm", "model.points_per_cell=1", "test.duration=0.1 s"}));
  EXPECT_FALSE(
      marked_as("one point a cell", {"model.cell=20 mm", "model.points_per_cell=2", "test.duration=0.1 s"}));
}

// A foot of 3.5 cells that are 20 times as high is read 12 % too far before anything moves.
TEST(SlumpFlowChecks, UprightCellsAreMarked) {
  EXPECT_TRUE(
      marked_as("times as high as wide", {"model.cell=[\"5 mm\", \"25 mm\"]", "test.duration=0.05 s"}));
  EXPECT_FALSE(
      marked_as("times as high as wide", {"model.cell=[\"10 mm\", \"20 mm\"]", "test.duration=0.05 s"}));
}

TEST(SlumpFlowChecks, InThreeDimensionsABodyIsThinSooner) {
  const std::vector<std::string> fluid{"mix.yield_stress=40 Pa", "mix.plastic_viscosity=20 Pa.s"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), fluid.begin(), fluid.end());
    return marked_as_thin(more);
  };
  EXPECT_TRUE(with({"model.space=quarter", "model.cell=15 mm", "model.points_per_cell=[4,1]"}));
  EXPECT_FALSE(with({"model.cell=15 mm"}));
}

// 25 Pa and 0.07 Pa.s spread 4.9 % less far on the default cells than on half of them, whose Reynolds number of a cell is 230
// by the speed that it had; 3 Pa.s are within 0.9 % at 3.7.
TEST(SlumpFlowChecks, InertiaThatCellsDampIsFlagged) {
  EXPECT_TRUE(
      marked_as("Reynolds number of a cell", {"mix.yield_stress=25 Pa", "mix.plastic_viscosity=0.07 Pa.s"}));
  EXPECT_FALSE(
      marked_as("Reynolds number of a cell", {"mix.yield_stress=25 Pa", "mix.plastic_viscosity=3 Pa.s"}));
  // The consistency of a shear-thinning law at the rate of a cell.
  Mix mix;
  mix.density = 2000.0;
  mix.mu = 0.0;
  const HerschelBulkley thinning{.k = 20.0, .n = 0.5};
  EXPECT_EQ(experiment::inertia_on_a_cell(mix, thinning, 0.5, 0.002), "");
  EXPECT_NE(experiment::inertia_on_a_cell(mix, thinning, 5.0, 0.02), "");
}

// 3.2 cells to the rim and 1.4 rows at rest: 361 mm, where half the cells have 385 and the default 393.
TEST(SlumpFlowChecks, ALowBodyOfFewCellsIsMarked) {
  EXPECT_TRUE(
      marked_as("from its axis to its rim", {"mix.yield_stress=365 Pa", "mix.plastic_viscosity=11 Pa.s",
                                             "test.duration=10 s", "model.cell=[\"31.4 mm\", \"39.4 mm\"]"}));
}

// A body that slides is 5 % off with three cells from its axis to its rim, one that its floor holds is not. At a coefficient of
// 0.05 the floor bears 11 Pa and cannot shear a concrete of 54 Pa, but one that flows below its yield stress; a coefficient of
// 0.35 bears 262 Pa under 32 mm.
TEST(SlumpFlowChecks, AFloorThatBearsLessThanTheYieldStressCountsAsSliding) {
  const auto on = [](const char* coefficient, const char* yield) {
    return marked_as("from its axis to its rim",
                     {"mix.yield_stress=54 Pa", "floor.contact=friction", "model.cell=30 mm",
                      std::string("floor.coefficient=") + coefficient, std::string("model.yield=") + yield});
  };
  EXPECT_TRUE(on("0.05", "exact"));
  EXPECT_TRUE(on("0", "exact"));
  EXPECT_FALSE(on("0.1", "papanastasiou"));
  EXPECT_FALSE(on("0.35", "exact"));
}

// No friction is none by either name: after 0.2 s the concrete is more than 1.2 cells of 20 mm thick, after 0.7 s less than half
// of one.
TEST(SlumpFlowChecks, AFloorWithoutFrictionIsMarkedAsAFreeOneIs) {
  for (const char* time : {"0.2 s", "0.7 s"}) {
    const std::string duration = std::string("test.duration=") + time;
    const bool free = marked_as_thin({"model.cell=20 mm", duration, "floor.contact=free_slip"});
    EXPECT_EQ(free, std::string(time) == "0.7 s");
    EXPECT_EQ(free, marked_as_thin(
                        {"model.cell=20 mm", duration, "floor.contact=friction", "floor.coefficient=0"}));
  }
}

// A fiftieth of the concrete through the cone's wall moves t500 by less than 2 %, a twentieth by 6 % (lift.md).
TEST(SlumpFlowChecks, ConcreteThatGoesThroughTheConeIsMarked) {
  for (const auto& [through, marked] : {std::pair{0.03, true}, {0.015, false}}) {
    cone::Outcome outcome;
    outcome.results.through_the_cone = through;
    EXPECT_EQ(!cone::went_through_the_cone({{}, outcome}).empty(), marked) << through;
  }
}

// A cone that does not rise holds its concrete: nothing stands beyond its wall, to 0.1 %.
TEST(SlumpFlowChecks, NothingPassesAConeThatStands) {
  for (const auto& [cell, duration] : {std::pair{0.02, 10.0}, {0.01, 1.0}}) {
    cone::Scene scene;
    scene.mix.tau_0 = 20.0, scene.mix.mu = 20.0;
    scene.model.cell = {cell, 0.5 * cell};
    scene.lift_speed = 1e-9, scene.duration = duration;
    const auto outcome = cone::run(scene);
    ASSERT_TRUE(outcome.results.through_the_cone.has_value());
    EXPECT_LE(*outcome.results.through_the_cone, 1e-3) << cell;
  }
}

// After 1 s at 40 mm/s the rim is 40 mm up: two cells of 20 mm, by which a mix of 5 Pa and 3 Pa s has spread to 547 mm;
// on cells of 5 mm, 8 of them, it has 616 mm.
TEST(SlumpFlowChecks, AnOpeningOfTwoCellsIsMarked) {
  const auto marked = [](const char* cell) {
    return marked_as("rim has risen",
                     {"mix.yield_stress=5 Pa", "mix.plastic_viscosity=3 Pa.s", "test.lift_speed=40 mm/s",
                      "test.duration=1 s", std::string("model.cell=") + cell});
  };
  EXPECT_TRUE(marked("20 mm"));
  EXPECT_FALSE(marked("[\"20 mm\", \"10 mm\"]"));
}

// Slow lifts are verified from 5 mm/s on (lift.md).
TEST(SlumpFlowChecks, ALiftSlowerThanAnyVerifiedIsMarked) {
  const auto marked = [](const char* speed) {
    return marked_as("nothing is verified",
                     {"test.duration=0.1 s", std::string("test.lift_speed=") + speed, "model.cell=20 mm"});
  };
  EXPECT_TRUE(marked("1 mm/s"));
  EXPECT_TRUE(marked("4.9 mm/s"));
  EXPECT_FALSE(marked("5 mm/s"));
  EXPECT_FALSE(marked("instant"));
}

// 300 Pa under a cone lifted at 40 mm/s spread to 536 mm on cells of 30 mm and to 613 mm on those of 6 mm where nothing holds
// them along the floor; at 10 mm/s to 442 and 614 mm with a friction of 0.1, to 374 and 384 mm where the floor holds.
TEST(SlumpFlowChecks, ASlowLiftOverASlipperyFloorIsMarkedOnCoarseCells) {
  const auto marked = [](std::vector<std::string> more) {
    more.insert(more.end(), {"mix.yield_stress=300 Pa", "model.cell=[\"24 mm\", \"30 mm\"]"});
    return marked_as("the lift is too slow for a sliding floor", more);
  };
  EXPECT_TRUE(marked({"test.lift_speed=40 mm/s", "floor.contact=free_slip"}));
  EXPECT_TRUE(marked({"test.lift_speed=100 mm/s", "floor.contact=free_slip"}));
  EXPECT_TRUE(marked({"test.lift_speed=10 mm/s", "floor.contact=friction", "floor.coefficient=0.1"}));
  EXPECT_FALSE(marked({"test.lift_speed=10 mm/s", "floor.contact=no_slip"}));
  EXPECT_FALSE(marked({"test.lift_speed=150 mm/s", "floor.contact=free_slip"}));
}

// A wall just stiff enough for the pressure in one step let 17 % through at 5 mm/s (lift.md).
TEST(SlumpFlowChecks, ASlowConeHoldsTheConcreteBack) {
  const auto marked = [](const char* speed, const char* duration) {
    return marked_as("through the cone's wall",
                     {"mix.yield_stress=54 Pa", std::string("test.lift_speed=") + speed,
                      std::string("test.duration=") + duration});
  };
  EXPECT_FALSE(marked("5 mm/s", "1.1 s"));
  EXPECT_FALSE(marked("15 cm/s", "0.5 s"));
}

// A fill of 300 mm at K = 1 MPa starts 0.43 % compressed: 1.8 % is three times that and half a per cent more.
TEST(SlumpFlowChecks, AVolumeThatTheWeightDoesNotExplainIsMarked) {
  for (const auto& [end, marked] :
       {std::pair{-0.0247, true}, {0.02, true}, {-0.017, false}, {-3e-4, false}}) {
    Checks checks;
    checks.volume_change = end;
    experiment::judge_volume(-0.00428, checks);
    EXPECT_EQ(!checks.reasons.empty(), marked) << end;
    checks.reasons.clear();
    checks.max_speed_end = 0.5;  // it may have just hit the floor
    experiment::judge_volume(-0.00428, checks);
    EXPECT_TRUE(checks.reasons.empty()) << end;
  }
}

// A point of 2 kg that flies at 3 m/s, half a metre up: 9 J and 2 g 0.5. Compressed by dJ it stores what its
// pressure does along the way: K V0 dJ^2/2 to first order in dJ.
TEST(SlumpFlowChecks, EnergyOfAPoint) {
  Points<3> points;
  add_point<3>(points, {0.1, 0.2, 0.5}, 2.0, 1e-3, 0.0);
  points.v[0] = {0.0, 3.0, 0.0};
  const double K = 1e6, rest = experiment::energy_of<ThreeD>(points, K);
  EXPECT_NEAR(rest, 9.0 + 2.0 * 9.81 * 0.5, 1e-3 * 2.0 * 0.5);  // g to three digits
  points.ln_J[0] = std::log(1.0 - 1e-3);
  EXPECT_NEAR(experiment::energy_of<ThreeD>(points, K) - rest, 0.5 * K * 1e-3 * 1e-6, 1e-3 * 0.5 * K * 1e-9);
}

// What a wall gives is allowed, what comes from nowhere is not.
TEST(SlumpFlowChecks, GainedEnergyIsMarked) {
  const auto reasons = [](const std::vector<std::pair<double, bool>>& readings) {
    experiment::EnergyWatch watch(100.0);
    for (const auto& [energy, pushed] : readings) watch.see(energy, pushed);
    Checks checks;
    watch.tell(checks);
    return checks.reasons.size();
  };
  EXPECT_EQ(reasons({{90.0, false}, {101.0, false}}), 0U);
  EXPECT_EQ(reasons({{120.0, true}, {121.0, false}}), 0U);
  EXPECT_EQ(reasons({{80.0, true}, {90.0, false}, {70.0, false}}), 1U);
  EXPECT_EQ(reasons({{500.0, true}, {400.0, false}}), 1U);  // more than a wall can give
}

// A body that has gained more than all that it had stays one that ran away, whatever it loses later.
TEST(SlumpFlowChecks, TwiceTheEnergyRanAway) {
  experiment::EnergyWatch watch(100.0);
  watch.see(199.0, false);
  EXPECT_FALSE(watch.ran_away());
  watch.see(201.0, false);
  watch.see(50.0, false);
  EXPECT_TRUE(watch.ran_away());
}

// A cone of 300 mm bears its own weight where the yield stress is above rho g H / sqrt(3) = 4.1 kPa. It comes to rest,
// although what a step leaves there quivers by 0.1 mm/s, and has no class.
TEST(SlumpFlowChecks, AConeThatBearsItselfStands) {
  const auto outcome = scene::run(scene::read_text(thin, "stiff.toml",
                                                   {"mix.yield_stress=5000 Pa", "test.duration=30 s",
                                                    "test.lift_speed=15 cm/s", "model.cell=[20 mm, 10 mm]"}));
  EXPECT_TRUE(outcome.checks.reasons.empty());
  EXPECT_FALSE(outcome.moving_at_end);
  EXPECT_NE(outcome.judged.find("kept the cone's shape"), std::string::npos) << outcome.judged;
}

// What comes to rest at 490 mm might reach 500 on other cells, 9.2 s on one grid and 11.9 s on another; 430 mm do not. Without
// a measurement the report says what its error bar leaves out, and of a rested concrete that alpha decides.
TEST(SlumpFlowChecks, WhatTheErrorBarLeavesOutIsSaid) {
  const auto remarks = [](const std::vector<std::string>& overrides) {
    std::vector<std::string> all = {"test.duration=60 s", "model.cell=[20 mm, 10 mm]"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    const auto outcome = scene::run(scene::read_text(thin, "near.toml", all));
    EXPECT_FALSE(outcome.moving_at_end);
    std::string text;
    for (const auto& remark : outcome.remarks) text += remark + "\n";
    for (const auto& line : outcome.lines) text += line + "\n";
    return text;
  };
  const auto says = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  const std::string near = remarks({"mix.yield_stress=85 Pa"}),
                    rested = remarks({"mix.yield_stress=130 Pa", "test.rest=60 s",
                                      "mix.thixotropy.structuration_rate=0.5 Pa/s",
                                      "mix.thixotropy.destructuration=0.2"});
  EXPECT_TRUE(says(near, "not to be relied on")) << near;
  EXPECT_TRUE(says(near, "Not compared with a measurement")) << near;
  EXPECT_FALSE(says(near, "decides how much")) << near;
  EXPECT_TRUE(says(rested, "(here 0.2) decides how much")) << rested;
  EXPECT_FALSE(says(rested, "not to be relied on")) << rested;
}

// Explicit steps at 2 GPa run away on the paper's cells: single precision survives until 0.06 s, with a body
// that has risen above the cone. It must not pass as a result.
TEST(SlumpFlowChecks, StiffExplicitStepsThatMakeEnergyAreMarked) {
  for (const char* precision : {"single", "double"}) {
    const auto outcome =
        scene::run(scene::read_text("apparatus = \"slump_flow\"\npreset = \"paper\"\nmix = "
                                    "\"mix_a\"\n[test]\nduration = \"0.06 s\"\nlift_speed = "
                                    "\"instant\"\n[output]\nframes = false\n",
                                    "stiff.toml",
                                    {"model.space=quarter", "model.cell=20 mm", "model.time_step=auto",
                                     "mix.bulk_modulus=2 GPa", std::string("model.precision=") + precision}));
    EXPECT_FALSE(outcome.checks.reasons.empty()) << precision;
  }
}

// A frame takes over what a reading brought, which is then brought again: the run goes on as without frames,
// and every frame has all points with all their fields, a mix without thixotropy its shear rates too.
TEST(SlumpFlowChecks, FramesDoNotChangeAnExplicitRun) {
  const std::vector<std::string> cone = {
      "model.scheme=explicit",   "model.yield=papanastasiou", "model.space=quarter",
      "model.cell=25 mm",        "test.duration=0.13 s",      "test.lift_speed=0.15 m/s",
      "mix.bulk_modulus=33 kPa", "output.frames=true",        "output.frame_interval=30 ms"};
  const std::vector<std::string> kinds[] = {
      {}, {"mix.thixotropy.structuration_rate=1.3 Pa/s", "mix.thixotropy.destructuration=0.01"}};
  for (const auto& kind : kinds) {
    std::vector<std::string> overrides = cone;
    overrides.insert(overrides.end(), kind.begin(), kind.end());
    const auto scene = scene::read_text(thin, "thin.toml", overrides);
    std::vector<Frame> frames;
    scene::Observer observer;
    observer.on_frame = [&](const Frame& frame) { frames.push_back(frame); };
    const auto seen = scene::run(scene, observer), unseen = scene::run(scene);
    ASSERT_GE(frames.size(), 5u);
    for (const Frame& frame : frames) {
      const std::size_t n = frames.front().position.size();
      for (const std::size_t size : {frame.position.size(), frame.velocity.size(), frame.volume.size(),
                                     frame.pressure.size(), frame.shear_rate.size()})
        EXPECT_EQ(size, n);
      EXPECT_EQ(frame.flocculation.size(), kind.empty() ? 0 : n);
    }
    EXPECT_GT(*std::max_element(frames.back().shear_rate.begin(), frames.back().shear_rate.end()), 0.0);
    ASSERT_EQ(seen.series.size(), unseen.series.size());
    for (std::size_t k = 0; k < seen.series.size(); ++k)
      EXPECT_EQ(seen.series[k].values, unseen.series[k].values);
  }
}

}  // namespace
}  // namespace tremie
