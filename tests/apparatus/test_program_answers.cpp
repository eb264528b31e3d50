// What the program answers: results side by side, one JSON object for machines, and questions under other names.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

using test::Result;
using test::shell;

class Answers : public ::testing::Test {
 protected:
  void SetUp() override {
    test::write_file(
        folder_ / "quick.toml",
        "apparatus = \"slump_flow\"\nmix = \"mix_c\"\n[test]\nduration = \"0.1 s\"\nlift_speed = "
        "\"instant\"\n[model]\ncell = \"20 mm\"\npoints_per_cell = 2\n");
  }
  Result tremie(const std::string& arguments, const std::string& after = "") {
    return shell("env -u DISPLAY '" TREMIE_PROGRAM "' " + arguments + " " + after, folder_.path());
  }
  /// The standard output alone, as JSON: throws where it is anything but one object.
  nlohmann::json json(const std::string& arguments) {
    return nlohmann::json::parse(tremie(arguments, "2>/dev/null").text);
  }

  test::TemporaryFolder folder_;
};

// Two runs that differ by 60 s of rest: the scene differs in that one key, a column a run stands in the table, and the
// values are those of the runs' own summaries.
TEST_F(Answers, CompareSaysWhatDiffers) {
  ASSERT_EQ(tremie("run quick.toml --quiet --out fresh").code, 0);
  ASSERT_EQ(tremie("run quick.toml --quiet --out rested --set test.rest='60 s'").code, 0);
  const auto results = json("compare fresh rested --json --out both")["results"];
  EXPECT_EQ(results["scene_differences"], (nlohmann::json{{"test.rest", {"0 s", "60 s"}}}));
  const auto own = nlohmann::json::parse(test::read_file(folder_ / "rested/summary.json"))["results"];
  EXPECT_EQ(results["result_differences"]["height_mm"]["values"][1], own["height_mm"]);
  EXPECT_TRUE(test::read_file(folder_ / "both/compare.csv")
                  .starts_with("part,key,fresh,rested\nscene,test.rest,0 s,60 s\n"));
  EXPECT_NE(test::read_file(folder_ / "both/report.html").find("<svg"), std::string::npos);
}

// Of a run with an error and one without, the one that states it is named, and its ± stands beside its number.
TEST_F(Answers, CompareNamesTheRunThatStatesItsError) {
  ASSERT_EQ(tremie("run quick.toml --quiet --out plain").code, 0);
  ASSERT_EQ(tremie("run quick.toml --quiet --out with --with-error --set test.rest='60 s'").code, 0);
  const Result said = tremie("compare with plain --out both");
  EXPECT_EQ(said.code, 0);
  EXPECT_NE(said.text.find("with states the error by cells and steps"), std::string::npos) << said.text;
  EXPECT_NE(said.text.find("plain does not (--with-error)"), std::string::npos) << said.text;
  EXPECT_NE(said.text.find(" ± "), std::string::npos) << said.text;
  const std::string page = test::read_file(folder_ / "both/report.html");
  EXPECT_NE(page.find("plain does not (--with-error)"), std::string::npos);
  EXPECT_NE(page.find(" ± "), std::string::npos);
}

TEST_F(Answers, ResumeSaysWhetherThereIsAFolder) {
  EXPECT_NE(tremie("resume nothere").text.find("there is no such folder"), std::string::npos);
  std::filesystem::create_directory(folder_ / "empty");
  EXPECT_NE(tremie("resume empty").text.find("holds no unfinished run"), std::string::npos);
}

TEST_F(Answers, EstimateSuggestsTheUnitThatIsMeant) {
  EXPECT_NE(tremie("estimate --spread 590").text.find("write \"590 mm\""), std::string::npos);
  EXPECT_NE(tremie("estimate --spread 59").text.find("write \"59 cm\""), std::string::npos);
}

// A script whose variable is empty, and a number behind a flag, are no options that were left out.
TEST_F(Answers, AnEmptyOptionAndAFlagWithAValueAreRefused) {
  for (const char* arguments :
       {"estimate --spread '590 mm' --t500 ''", "estimate --spread '590 mm' --chart ''",
        "check quick.toml --json=5", "run quick.toml --quiet=5", "run ''", "resume ''",
        "run quick.toml --out ''"}) {
    const Result said = tremie(arguments);
    EXPECT_EQ(said.code, 2) << arguments << '\n' << said.text;
    const bool flag = std::string_view(arguments).find("=5") != std::string_view::npos;
    EXPECT_NE(said.text.find(flag ? "takes no value" : "is empty"), std::string::npos) << said.text;
  }
}

// What is no result, or of another apparatus, is named with what it lacks, and nothing is written.
TEST_F(Answers, CompareRefusesWhatItCannotSetSideBySide) {
  ASSERT_EQ(tremie("run quick.toml --quiet --out fresh").code, 0);
  std::filesystem::create_directory(folder_ / "empty");
  const auto refused = [&](const std::string& folders, const std::string& why) {
    const Result result = tremie("compare " + folders + " --out both");
    EXPECT_EQ(result.code, 2) << folders;
    EXPECT_NE(result.text.find(why), std::string::npos) << result.text;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "both"));
  };
  refused("fresh", "two or more");
  refused("fresh fresh", "same folder");
  refused("fresh nowhere", "no such folder");
  refused("fresh empty", "summary.json is missing");
  test::write_file(
      folder_ / "empty/summary.json",
      R"({"apparatus": "l_box", "status": "completed", "results": {}, "checks": {"reasons": []}})");
  refused("fresh empty", "holds a l_box without its scene.toml");
}

// One object and nothing else on the standard output, whatever the command; a scene comes through a pipe.
TEST_F(Answers, JsonIsOneObject) {
  EXPECT_EQ(json("run quick.toml --json")["status"], "completed");
  const auto check = json("check - --json <quick.toml");
  EXPECT_EQ(check["scene"]["test.duration"], "0.1 s");
  EXPECT_GT(check["cost"]["cpu_s"]["high"], check["cost"]["cpu_s"]["low"]);
  EXPECT_EQ(tremie("check quick.toml --json --set mix.yield_stress=-5", "2>/dev/null").text, "");
}

// People ask in other words: the message names the command that does it.
TEST_F(Answers, MessagesNameTheCommand) {
  const auto names = [&](const std::string& arguments, const std::string& command) {
    const Result result = tremie(arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_NE(result.text.find(command), std::string::npos) << arguments << ": " << result.text;
  };
  names("invert", "tremie calibrate");
  names("sweep", "tremie study");
  names("run quick.toml --pdf", "print");
  names("run", "tremie new slump_flow");
  names("run quick.toml quick.toml", "tremie compare");
  names("fit record.csv --spread 5", "tremie estimate");
  names("check quick.toml --set mix.yield_stress='40 Pa..80 Pa'", "tremie study");
}

}  // namespace
}  // namespace tremie
