// The program as a person uses it: exit codes, messages, files.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

using test::Result;
using test::shell;

const std::string tremie_program = TREMIE_PROGRAM;

/// A scene that is done in a moment.
const std::string quick = R"(apparatus = "slump_flow"
mix = "mix_c"
[test]
duration = "0.1 s"
lift_speed = "instant"
[model]
cell = "20 mm"
points_per_cell = 2
[output]
frame_interval = "0.05 s"
)";

class Program : public ::testing::Test {
 protected:
  void SetUp() override { test::write_file(folder_ / "quick.toml", quick); }

  Result tremie(const std::string& arguments) {
    return shell("env -u DISPLAY '" + tremie_program + "' " + arguments, folder_.path());
  }
  /// Nothing but the scenes that the test wrote itself.
  bool nothing_written() const {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      if (entry.path().extension() != ".toml") return false;
    return true;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Program, RunFillsItsFolder) {
  const Result result = tremie("run quick.toml");
  EXPECT_EQ(result.code, 0) << result.text;
  const auto run = folder_ / "runs/quick";
  const auto summary = nlohmann::json::parse(test::read_file(run / "summary.json"));
  EXPECT_EQ(summary["status"], "completed");
  for (const char* key :
       {"spread_mm", "spread_max_point_mm", "height_mm", "t500_s", "stopped_at_s", "class_en12350_8",
        "flocculation_mean_start", "flocculation_mean_end", "shear_rate_mean_peak_per_s"})
    EXPECT_TRUE(summary["results"].contains(key)) << key;
  EXPECT_TRUE(summary["results"]["t500_s"].is_null());
  EXPECT_GT(summary["cost"]["cpu_s"], 0.0);
  EXPECT_GT(summary["cost"]["peak_rss_bytes"], 1000000);
  EXPECT_TRUE(
      test::read_file(run / "timeseries.csv")
          .starts_with(
              "time_s,spread_mm,spread_max_point_mm,height_mm,max_speed_m_per_s,shear_rate_mean_per_s,"
              "flocculation_mean,volume_change"));
  EXPECT_TRUE(std::filesystem::exists(run / "frames.pvd"));
}

TEST_F(Program, TheResolvedSceneGivesTheSameResult) {
  ASSERT_EQ(tremie("run quick.toml --quiet --out a").code, 0);
  ASSERT_EQ(tremie("run a/scene.toml --quiet --out b").code, 0);
  ASSERT_EQ(tremie("run quick.toml --quiet --out c").code, 0);
  EXPECT_TRUE(test::read_file(folder_ / "a/timeseries.csv") == test::read_file(folder_ / "b/timeseries.csv"));
  EXPECT_TRUE(test::read_file(folder_ / "a/results.h5") == test::read_file(folder_ / "c/results.h5"));
}

#ifdef __x86_64__
TEST_F(Program, AnUnknownLevelOfInstructionsIsRefused) {
  const std::string version = "' --version";
  const Result wrong = shell("TREMIE_LEVEL=v3 '" + tremie_program + version, folder_.path());
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.text.find("\"v3\"; allowed: x86-64-v4 x86-64-v3 x86-64-v2 x86-64"), std::string::npos)
      << wrong.text;
  EXPECT_EQ(shell("TREMIE_LEVEL=x86-64-v3 '" + tremie_program + version, folder_.path()).code, 0);
}
#endif

TEST_F(Program, QuietPrintsNothing) {
  const Result result = tremie("run quick.toml --quiet");
  EXPECT_EQ(result.text, "");
}

TEST_F(Program, AnEarlierResultIsKept) {
  ASSERT_EQ(tremie("run quick.toml --quiet --out a").code, 0);
  const std::string before = test::read_file(folder_ / "a/summary.json");
  const Result again = tremie("run quick.toml --out a");
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.text.find("--force"), std::string::npos);
  EXPECT_EQ(test::read_file(folder_ / "a/summary.json"), before);
  EXPECT_EQ(tremie("run quick.toml --quiet --out a --force").code, 0);
}

TEST_F(Program, BadInputIsExitCodeTwoAndWritesNothing) {
  test::write_file(folder_ / "bad.toml",
                   "apparatus = \"slump_flow\"\nmix = \"mix_a\"\n[cone]\nheight = 300\n");
  for (const std::string arguments :
       {"run bad.toml", "run none.toml", "run quick.toml --set mix.yield_stress=54",
        "run quick.toml --set mix.yield_stress='-1 Pa'", "run quick.toml --set model.cell='0 mm'",
        "run quick.toml --out quick.toml", "run quick.toml --out quick.toml/below",
        "run quick.toml --out /proc/nowhere", "run", "run quick.toml --threads 0", "run quick.toml --colour",
        "dance", "", "new l_bx", "check bad.toml"}) {
    const Result result = tremie(arguments);
    EXPECT_EQ(result.code, 2) << arguments << "\n" << result.text;
    EXPECT_FALSE(result.text.empty()) << arguments;
    EXPECT_TRUE(nothing_written()) << arguments;
  }
  EXPECT_NE(tremie("run bad.toml").text.find("bad.toml:4: cone.height"), std::string::npos);
}

TEST_F(Program, AnUnknownCommandOrOptionIsToldWhatThereIs) {
  for (const auto& [arguments, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"rum quick.toml", {"\"rum\"", "\"run\"", "check", "verify"}},
           {"run quick.toml --thread 2", {"tremie run", "\"--thread\"", "\"--threads\"", "--accuracy"}},
           {"--verson", {"\"--verson\"", "\"--version\""}},
           {"fit quick.toml --sped 1", {"tremie fit", "\"--speed\"", "--rest"}}}) {
    const Result result = tremie(arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    for (const auto& part : parts)
      EXPECT_NE(result.text.find(part), std::string::npos) << part << " is not in: " << result.text;
  }
}

TEST_F(Program, OutputThatIsLostIsAFault) {
  EXPECT_EQ(tremie("new slump_flow > /dev/full").code, 1);
  EXPECT_EQ(tremie("check quick.toml > /dev/full").code, 1);
}

// Against 540 mm of a mix of 1 MPa: 567 mm at 20 kPa, 654 mm at 5 kPa (20 and 60 % of the volume); at 100 Pa there is no body.
TEST_F(Program, AMixThatItsWeightSqueezesIsFlaggedOrEnded) {
  for (const char* K : {"20 kPa", "5 kPa", "100 Pa"}) {
    const Result result =
        tremie("run quick.toml --out soft --force --quiet --set mix.bulk_modulus='" + std::string(K) + "'");
    EXPECT_EQ(result.code, 3) << K;
    EXPECT_NE(result.text.find("larger mix.bulk_modulus"), std::string::npos) << K << result.text;
  }
  EXPECT_NE(test::read_file(folder_ / "soft/summary.json").find("the run ends there"), std::string::npos);
  EXPECT_EQ(tremie("run quick.toml --out soft --force --quiet --set mix.bulk_modulus='50 kPa'").code, 0);
}

TEST_F(Program, ABodyThatDoesNotMoveIsToldAsSuch) {
  const Result result = tremie("run quick.toml --out still --set mix.yield_stress='54 kPa'");
  EXPECT_NE(result.text.find("moved           no"), std::string::npos) << result.text;
  const auto note = result.text.find("54 kPa is unusual");
  EXPECT_NE(note, std::string::npos) << result.text;
  EXPECT_EQ(result.text.find("is unusual", note + 10), std::string::npos) << result.text;
}

TEST_F(Program, MoreThreadsThanProcessorsAreNotedOnce) {
  const std::string run = "run quick.toml --out t --force --threads 64";
  const Result result = tremie(run);
  EXPECT_EQ(result.text.find("note: --threads"), result.text.rfind("note: --threads")) << result.text;
  EXPECT_EQ(tremie(run + " --quiet").text.find("note"), std::string::npos);
}

TEST_F(Program, ARunIsWatchedUntilItEnds) {
  EXPECT_EQ(tremie("watch nothing").code, 2);
  const Result result = shell(
      "'" + tremie_program +
          "' run quick.toml --quiet --out w --set test.duration='1000 s' --set model.cell='3 mm' "
          "& run=$!; sleep 1; '" +
          tremie_program + "' watch w & watch=$!; sleep 1.5; kill -TERM $run; wait $watch; echo ended $?",
      folder_.path());
  EXPECT_NE(result.text.find("s of 1000 s   step"), std::string::npos) << result.text;
  EXPECT_NE(result.text.find("frames so far"), std::string::npos) << result.text;
  EXPECT_NE(result.text.find("ended 0"), std::string::npos) << result.text;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "w/progress.txt"));
}

// A message that nobody can read changes no exit code; it once ended the program with 134.
TEST_F(Program, ClosedAndFullStreamsKeepTheExitCode) {
  test::write_file(folder_ / "bad.toml", "apparatus = \"slump_flow\"\nmix = \"nix\"\n");
  for (const auto& [arguments, code] :
       std::vector<std::pair<std::string, int>>{{"run quick.toml --out a --force", 0},
                                                {"run bad.toml", 2},
                                                {"check bad.toml", 2},
                                                {"new nix", 2},
                                                {"rum", 2}}) {
    for (const char* streams : {" 2>&-", " 2>/dev/full", " >&-", " >/dev/full", " >&- 2>&-"})
      EXPECT_EQ(tremie(arguments + streams).code, code) << arguments << streams;
  }
  for (const char* asked : {"check quick.toml", "new slump_flow", "--version"}) {
    EXPECT_EQ(tremie(std::string(asked) + " >&-").code, 0) << asked;
    EXPECT_EQ(tremie(std::string(asked) + " >/dev/full").code, 1)
        << asked;  // a file that would be half written
  }
}

TEST_F(Program, WhatASchemeCannotRunIsToldWithItsPlace) {
  test::write_file(
      folder_ / "bad.toml",
      "apparatus = \"slump_flow\"\nmix = \"mix_a\"\n[model]\nscheme = \"explicit\"\nyield = \"exact\"\n");
  const Result result = tremie("run bad.toml");
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.text.find("bad.toml:5: model.yield"), std::string::npos) << result.text;
  const Result check = tremie("check bad.toml");
  EXPECT_EQ(check.code, 2);
  EXPECT_EQ(check.text.find("valid"), std::string::npos) << check.text;
  EXPECT_TRUE(nothing_written());
}

TEST_F(Program, AFullDiskLeavesNothingHalfWritten) {
  // A limit on the size of files stands in for a full disk: results.h5 passes it, and its signal is ignored.
  const Result result =
      shell("trap '' XFSZ; ulimit -f 8; env -u DISPLAY '" + tremie_program + "' run quick.toml --out a",
            folder_.path());
  EXPECT_EQ(result.code, 1) << result.text;
  EXPECT_NE(result.text.find("cannot be written"), std::string::npos) << result.text;
  EXPECT_TRUE(nothing_written());
}

TEST_F(Program, CheckShowsDefaultsAndWhatIsLeftOut) {
  const Result result = tremie("check quick.toml --set mix.thixotropy=false");
  EXPECT_EQ(result.code, 0) << result.text;
  for (const char* part : {"# default", "flocculation: left out", "bytes a point", "active cells", "steps"})
    EXPECT_NE(result.text.find(part), std::string::npos) << part;
  EXPECT_TRUE(nothing_written());
}

TEST_F(Program, NewMakesASceneThatChecks) {
  EXPECT_EQ(tremie("new slump_flow > mine.toml && '" + tremie_program + "' check mine.toml").code, 0);
}

TEST_F(Program, VerifyWritesItsDocument) {
  EXPECT_EQ(tremie("verify law --out v").code, 0);
  EXPECT_NE(test::read_file(folder_ / "v/VERIFICATION.md").find("Every bound is kept."), std::string::npos);
  EXPECT_EQ(tremie("verify law --out v").code, 2) << "an earlier result";
  EXPECT_EQ(tremie("verify 1 --out v --force").code, 0);
  const Result unknown = tremie("verify lav --out w");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.text.find("law (1)"), std::string::npos) << unknown.text;
}

TEST_F(Program, RunStatesItsError) {
  const Result result = tremie("run quick.toml --with-error --out a");
  EXPECT_EQ(result.code, 0) << result.text;
  EXPECT_NE(result.text.find("spread "), std::string::npos);
  EXPECT_NE(result.text.find(" ± "), std::string::npos) << result.text;
  const auto summary = nlohmann::json::parse(test::read_file(folder_ / "a/summary.json"));
  EXPECT_GT(summary["error"]["spread_mm"], 0.0);
  EXPECT_TRUE(summary["error"]["basis"].is_string());
}

TEST_F(Program, AccuracyChoosesTheCells) {
  const Result result = tremie("run quick.toml --accuracy '5 %' --out a");
  EXPECT_NE(result.text.find("accuracy        5 % wants model.cell="), std::string::npos) << result.text;
  const Result bad = tremie("run quick.toml --accuracy 5 --out b");
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.text.find("\"1 %\""), std::string::npos) << bad.text;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b"));
}

TEST_F(Program, AnInterruptKeepsWhatThereIs) {
  // The run is far too long to end by itself. `timeout` signals the program and then its group: two
  // interrupts at once are one.
  const Result result =
      shell("env -u DISPLAY timeout -s INT --preserve-status 1 '" + tremie_program +
                "' run quick.toml --out a --set test.duration='1000 h' --set model.time_step='1e-6 s'"
                " --set output.frames=false",
            folder_.path());
  EXPECT_EQ(result.code, 130) << result.text;
  EXPECT_EQ(nlohmann::json::parse(test::read_file(folder_ / "a/summary.json"))["status"], "interrupted");
  EXPECT_EQ(result.text.find("test.duration"), std::string::npos) << result.text;
  const std::string report = test::read_file(folder_ / "a/report.html");
  EXPECT_NE(report.find("so far, interrupted at"), std::string::npos);
  EXPECT_EQ(report.find("when the time of the test was over"), std::string::npos);
}

}  // namespace
}  // namespace tremie
