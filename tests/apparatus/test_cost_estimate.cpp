// What `tremie check` says of the price: against CPU seconds measured for the shipped scenes, and for input that no
// program can run.

#include <gtest/gtest.h>

#include "apparatus/registry/cost_estimate.hpp"
#include "apparatus/run/machine/free_memory.hpp"

namespace tremie {
namespace {

scene::CostEstimate cost_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
  const auto scene = scene::read(std::string(TREMIE_SCENES) + "/" + name + ".toml", overrides);
  return scene::cost_of(scene, *scene::estimate(scene));
}

// CPU seconds, megabytes of memory and of files, one thread of an AMD EPYC of 2023; the estimate promises a factor of two.
TEST(CostEstimate, WithinAFactorOfTwoOverTheShippedScenes) {
  const struct {
    const char* scene;
    double cpu, memory, disk;
  } measured[] = {{"slump_flow_mix_a", 1.09, 28.0, 6.8},
                  {"slump_flow_mix_b", 0.94, 27.3, 6.1},
                  {"slump_flow_mix_c_rest240", 1.28, 26.1, 8.2},
                  {"slump_flow_mix_a_rest240", 1.30, 25.9, 8.2},
                  {"icar_vane_mix_a", 0.31, 22.3, 0.87},
                  {"icar_vane_flow_curve_mix_a", 0.15, 22.2, 1.1},
                  {"l_box_mix_a", 13.2, 46.8, 32.1},
                  {"l_box", 18.5, 44.6, 29.0},
                  {"slump_flow_mix_a_quarter", 3.46, 40.6, 10.0},
                  {"slump_flow_mix_a_full", 24.3, 83.8, 12.0},
                  // on a busy machine, without their files
                  {"slump_flow_mix_c", 0.89, 28.0, 0.0},
                  {"slump_flow_mix_b_rest240", 1.26, 27.0, 0.0},
                  {"icar_vane_site", 0.26, 23.0, 0.0},
                  {"icar_vane_mix_a_rest240", 0.24, 23.0, 0.0},
                  {"l_box_mix_a_rest240", 19.6, 45.0, 0.0},
                  {"paper_mix_a", 13.7, 30.0, 0.0},  // 0.5 s of it
                  {"paper_mix_a_rest240", 12.9, 30.0, 0.0},
                  {"paper_mix_b_rest240_safe_step", 22.6, 30.0, 0.0}};
  for (const auto& m : measured) {
    const bool paper = std::string(m.scene).starts_with("paper");
    const auto cost = cost_of(
        m.scene, paper ? std::vector<std::string>{"test.duration=0.5 s"} : std::vector<std::string>{});
    const auto within = [&](double estimated, double value, const char* what) {
      EXPECT_GT(estimated, 0.5 * value) << m.scene << ", " << what;
      EXPECT_LT(estimated, 2.0 * value) << m.scene << ", " << what;
    };
    within(cost.cpu, m.cpu, "CPU s");
    within(cost.memory / 1e6, m.memory, "MB of memory");
    if (m.disk > 0.0) within(cost.disk / 1e6, m.disk, "MB of files");
  }
}

// Steps that runs took. A cone at 20 to 80 mm/s has steps of 6 ms beside it.
TEST(CostEstimate, StepsAreNearThoseThatRunsTake) {
  const struct {
    const char* scene;
    std::vector<std::string> overrides;
    double steps;
  } taken[] = {{"slump_flow_mix_a", {}, 154},
               {"slump_flow_mix_b", {}, 143},
               {"slump_flow_mix_c", {}, 121},
               {"slump_flow_mix_a", {"test.lift_speed=5 cm/s"}, 223},
               {"slump_flow_mix_a", {"test.lift_speed=2 cm/s"}, 197},
               {"slump_flow_mix_a", {"test.lift_speed=instant"}, 153},
               {"slump_flow_mix_a", {"model.cell=[\"5 mm\", \"2.5 mm\"]"}, 259},
               {"slump_flow_mix_a", {"test.rest=60 s"}, 175},
               {"slump_flow_mix_a_rest240", {}, 195},
               {"slump_flow_mix_a_rest240", {"test.lift_speed=5 cm/s"}, 253},
               {"slump_flow_mix_b_rest240", {}, 191},
               {"slump_flow_mix_c_rest240", {}, 183}};
  for (const auto& t : taken) {
    const auto scene = scene::read(std::string(TREMIE_SCENES) + "/" + t.scene + ".toml", t.overrides);
    EXPECT_NEAR(static_cast<double>(scene::estimate(scene)->steps_expected) / t.steps, 1.0, 0.25)
        << t.scene << (t.overrides.empty() ? "" : ", " + t.overrides.front());
  }
}

// 1e9 s of flow in steps of 1 ns: a number that is large, never a negative one.
TEST(CostEstimate, ExtremesStayNumbers) {
  const auto scene = scene::read(std::string(TREMIE_SCENES) + "/slump_flow_mix_a.toml",
                                 {"test.duration=1e9 s", "model.time_step=1e-9 s"});
  const auto estimate = *scene::estimate(scene);
  EXPECT_GT(estimate.steps, 1000000000000);
  EXPECT_LE(estimate.steps_expected, estimate.steps);
  EXPECT_GT(scene::cost_of(scene, estimate).cpu_most, 1e9);
}

// What cannot be done is said before it begins, with the remedy.
TEST(CostEstimate, ObjectsToWhatTheMachineCannotDo) {
  const auto whole = cost_of("slump_flow_mix_a_full"),
             fine = cost_of("slump_flow_mix_a_full", {"model.cell=2 mm", "model.time_step=1 ms"});
  EXPECT_EQ(scene::objection(whole, 8e9, 1), "");
  EXPECT_NE(scene::objection(fine, 1e9, 1).find("memory"), std::string::npos);
  EXPECT_NE(scene::objection(fine, 1e15, 1).find("days"), std::string::npos);
}

// The least of the machine's memory, the control group's and the process's.
TEST(CostEstimate, FreeMemory) {
  const std::string meminfo = "MemTotal:       16000000 kB\nMemFree:  100 kB\nMemAvailable:    8000000 kB\n";
  EXPECT_EQ(experiment::free_memory(meminfo, "max\n", 1e300), 8192e6);
  EXPECT_EQ(experiment::free_memory(meminfo, "4000000000\n", 1e300), 4e9);
  EXPECT_EQ(experiment::free_memory(meminfo, "", 1e9), 1e9);
}

}  // namespace
}  // namespace tremie
