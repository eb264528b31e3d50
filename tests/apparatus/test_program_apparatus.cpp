// Every apparatus through the program: what a run leaves in its folder, from short runs with few cells.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

using nlohmann::json;

class Apparatus : public ::testing::Test {
 protected:
  test::Result tremie(const std::string& arguments) {
    return test::shell("env -u DISPLAY '" TREMIE_PROGRAM "' " + arguments, folder_.path());
  }
  /// Runs a scene of the tree into folder "a" and reads its summary.
  json run(const std::string& scene, const std::string& settings) {
    const auto result = tremie("run '" TREMIE_SCENES "/" + scene + ".toml' --out a --force " + settings);
    EXPECT_EQ(result.code, 0) << result.text;
    screen_ = result.text;
    return json::parse(test::read_file(folder_ / "a/summary.json"));
  }
  std::string file(const std::string& name) const { return test::read_file(folder_.path() / "a" / name); }
  bool there(const std::string& name) const { return std::filesystem::exists(folder_.path() / "a" / name); }

  test::TemporaryFolder folder_;
  std::string screen_;
};

constexpr const char* short_l_box =
    "--set test.duration='0.3 s' --set model.cell='25 mm' --set model.points_per_cell=2";

TEST_F(Apparatus, LBox) {
  const json summary = run("l_box_mix_a_rest240", short_l_box);
  EXPECT_EQ(summary["apparatus"], "l_box");
  const json& results = summary["results"];
  for (const char* key : {"h1_mm", "h2_mm", "passing_ratio", "t200_s", "t400_s", "class_en12350_10",
                          "stopped_at_s", "flocculation_mean_start", "flocculation_mean_end"})
    EXPECT_TRUE(results.contains(key)) << key;
  EXPECT_GT(results["h1_mm"], 50.0);
  for (const char* key : {"h2_mm", "passing_ratio", "t400_s", "class_en12350_10", "stopped_at_s"})
    EXPECT_TRUE(results[key].is_null()) << key;
  EXPECT_NEAR(results["flocculation_mean_start"], 1.3 * 240.0 / 54.0, 1e-9);
  EXPECT_TRUE(file("timeseries.csv").starts_with("time_s,front_mm,h1_mm,h2_mm,max_speed_m_per_s,"));
  EXPECT_TRUE(file("profile.csv").starts_with("distance_mm,depth_mm\n"));
  EXPECT_TRUE(there("frames.pvd"));
  EXPECT_NE(screen_.find("the channel's end was never reached"), std::string::npos) << screen_;
}

TEST_F(Apparatus, LBoxWithoutThixotropyHasNoFlocculation) {
  const json results = run("l_box", short_l_box)["results"];
  EXPECT_TRUE(results["flocculation_mean_start"].is_null());
  EXPECT_EQ(file("timeseries.csv").find("flocculation"), std::string::npos);
}

TEST_F(Apparatus, VaneAtConstantSpeed) {
  const json summary = run("icar_vane_mix_a_rest240",
                           "--set test.duration='0.5 s' --set model.cell='5 mm' --set test.speed='15 rpm'");
  EXPECT_EQ(summary["apparatus"], "icar_vane");
  const json& results = summary["results"];
  for (const char* key : {"torque_peak_N_m", "torque_end_N_m", "torque_wall_end_N_m", "torque_power_end_N_m",
                          "reiner_riwlin", "flocculation_apparent_start", "alpha_apparent", "alpha_window_s",
                          "shear_rate_nominal_per_s", "static_yield_stress_apparent_Pa",
                          "dynamic_yield_stress_apparent_Pa", "torque_couette_reference_N_m", "input"})
    EXPECT_TRUE(results.contains(key)) << key;
  EXPECT_GT(results["torque_end_N_m"], 0.0);
  EXPECT_EQ(results["input"]["yield_stress_Pa"], 54.0);
  EXPECT_NEAR(results["input"]["static_yield_stress_Pa"], 366.0, 1e-9);
  EXPECT_TRUE(
      file("timeseries.csv")
          .starts_with(
              "time_s,speed_rev_per_s,torque_N_m,torque_wall_N_m,torque_power_N_m,momentum_rate_N_m,"));
  EXPECT_TRUE(file("torque.csv").starts_with("time_s,torque_N_m\n"));
  EXPECT_TRUE(file("profile.csv").starts_with("radius_mm,velocity_m_per_s,shear_rate_per_s,flocculation\n"));
  EXPECT_FALSE(there("flow_curve.csv"));
  EXPECT_NE(screen_.find("instrument"), std::string::npos) << screen_;
}

TEST_F(Apparatus, VaneFlowCurve) {
  const json results =
      run("icar_vane_flow_curve_mix_a",
          "--set test.speeds='[\"0.4 rev/s\", \"0.1 rev/s\"]' --set test.pre_shear_time='0.2 s' "
          "--set test.hold_time='0.3 s' --set test.average_time='0.1 s' --set model.cell='5 mm'")["results"];
  EXPECT_GT(results["reiner_riwlin"]["yield_stress_Pa"], 0.0);
  EXPECT_GT(results["reiner_riwlin"]["plastic_viscosity_Pa_s"], 0.0);
  EXPECT_EQ(results["dynamic_yield_stress_apparent_Pa"], results["reiner_riwlin"]["yield_stress_Pa"]);
  EXPECT_TRUE(results["static_yield_stress_apparent_Pa"].is_null());
  const std::string curve = file("flow_curve.csv");
  EXPECT_TRUE(curve.starts_with("speed_rev_per_s,torque_N_m\n0.4,")) << curve;
  EXPECT_NE(curve.find("\n0.1,"), std::string::npos) << curve;
  EXPECT_EQ(std::count(curve.begin(), curve.end(), '\n'), 3);
  EXPECT_FALSE(there("torque.csv"));
}

TEST_F(Apparatus, AReversedVaneLeavesARecordThatCanBeFitted) {
  run("icar_vane_mix_a", "--set test.duration='0.8 s' --set model.cell='5 mm' --set test.speed='-15 rpm'");
  EXPECT_EQ(file("torque.csv").find(",-"), std::string::npos);
  EXPECT_NE(file("timeseries.csv").find(",-"), std::string::npos);
}

// While the vane starts, the torque is that of the concrete's inertia: after a microsecond 2.9 N m on the
// blades and nothing on the container, and half a second's mean is 4 % short of the steady 0.80 N m.
TEST_F(Apparatus, AVaneThatIsStillStartingIsMarked) {
  for (const char* space : {"couette", "plane"})
    for (const char* duration : {"1e-6 s", "1 ms", "0.1 s", "0.5 s"}) {
      const auto result = tremie("run '" TREMIE_SCENES
                                 "/icar_vane_mix_a.toml' --out a --force --set "
                                 "model.cell='5 mm' --set model.space=" +
                                 std::string(space) + " --set test.duration='" + duration + "'");
      EXPECT_EQ(result.code, 3) << space << " " << duration;
      EXPECT_NE(result.text.find("still being accelerated"), std::string::npos) << result.text;
    }
  run("icar_vane_mix_a", "--set test.duration='0.8 s' --set model.cell='5 mm'");
}

TEST_F(Apparatus, NewMakesScenesThatCheck) {
  for (const char* name : {"slump_flow", "l_box", "icar_vane"}) {
    const auto result =
        tremie("new " + std::string(name) + " > mine.toml && '" TREMIE_PROGRAM "' check mine.toml");
    EXPECT_EQ(result.code, 0) << result.text;
  }
}

TEST_F(Apparatus, BarsInThePlaneAreBadInput) {
  const auto result = tremie("run '" TREMIE_SCENES "/l_box.toml' --out a --set test.bars=2");
  EXPECT_EQ(result.code, 2);
  EXPECT_FALSE(there("."));
}

// The paper's step of 1e-4 s after 240 s of rest is longer than its scheme is stable for: everything is
// written, marked, and the program says so.
TEST_F(Apparatus, AnExplicitStepBeyondTheLimitIsMarked) {
  const std::string few = " --set model.space=axisymmetric --set test.duration='2 ms' --out a --force";
  const auto printed = tremie("run '" TREMIE_SCENES "/paper_mix_c_rest240.toml'" + few);
  EXPECT_EQ(printed.code, 3) << printed.text;
  const json checks = json::parse(file("summary.json"))["checks"];
  EXPECT_EQ(checks["stability_limit_exceeded"], true);
  ASSERT_EQ(checks["reasons"].size(), 1U);
  EXPECT_NE(checks["reasons"][0].get<std::string>().find("viscous limit"), std::string::npos);

  const auto safe = tremie("run '" TREMIE_SCENES "/paper_mix_c_rest240_safe_step.toml'" + few);
  EXPECT_EQ(safe.code, 0) << safe.text;
  EXPECT_EQ(json::parse(file("summary.json"))["checks"]["stability_limit_exceeded"], false);
}

TEST_F(Apparatus, AnExplicitStepNeedsABoundedViscosity) {
  const auto result =
      tremie("run '" TREMIE_SCENES "/slump_flow_mix_a.toml' --set model.scheme=explicit --out a");
  EXPECT_EQ(result.code, 2) << result.text;
  EXPECT_NE(result.text.find("model.yield"), std::string::npos) << result.text;
  EXPECT_FALSE(there("summary.json"));
}

}  // namespace
}  // namespace tremie
