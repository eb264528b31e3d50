// Studies as a person runs them: files, exit codes, going on after being killed, rows that die.

#include <gtest/gtest.h>
#include <signal.h>

#include <nlohmann/json.hpp>

#include "apparatus/study/rows/journal.hpp"
#include "apparatus/study/rows/pool.hpp"
#include "tests/apparatus/shell.hpp"
#include "tests/study/quick_study.hpp"

namespace tremie {
namespace {

class Study : public ::testing::Test {
 protected:
  void SetUp() override { test::write_quick_study(folder_, "method = \"grid\"\nlevels = 6\n"); }
  test::Result tremie(const std::string& arguments) {
    return test::shell("'" TREMIE_PROGRAM "' " + arguments, folder_.path());
  }
  std::string csv(const std::string& out) {
    return test::without_cpu(test::read_file(folder_ / (out + "/study.csv")));
  }
  test::TemporaryFolder folder_;
};

TEST_F(Study, FillsItsFolder) {
  const auto result = tremie("study STUDY.toml --out a --jobs 2");
  EXPECT_EQ(result.code, 0) << result.text;
  const auto text = test::read_file(folder_ / "a/study.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "row,mix.yield_stress_Pa,test.rest_s,spread_mm,t500_s,status,exit_code,reasons,cpu_s");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 13);
  const auto summary = nlohmann::json::parse(test::read_file(folder_ / "a/summary.json"));
  EXPECT_EQ(summary["results"]["rows_done"], 12);
  for (const char* file : {"design.csv", "study.h5"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / ("a/" + std::string(file))));
  EXPECT_EQ(tremie("study STUDY.toml --out a").code, 2);  // never over an earlier study
}

TEST_F(Study, GoesOnToTheSameBytesWhereverItWasCut) {
  ASSERT_EQ(tremie("study STUDY.toml --out whole --jobs 1 --quiet").code, 0);
  const auto journal = test::read_file(folder_ / "whole/journal.jsonl");
  for (const double share : {0.02, 0.35, 0.71}) {
    std::filesystem::remove_all(folder_ / "cut");
    std::filesystem::create_directory(folder_ / "cut");
    test::write_file(folder_ / "cut/design.csv", test::read_file(folder_ / "whole/design.csv"));
    test::write_file(
        folder_ / "cut/journal.jsonl",
        journal.substr(0, static_cast<std::size_t>(share * static_cast<double>(journal.size()))));
    ASSERT_EQ(tremie("study STUDY.toml --out cut --resume --quiet").code, 0);
    EXPECT_EQ(csv("cut"), csv("whole")) << share;
  }
}

TEST_F(Study, KilledWhileAtWorkGoesOn) {
  tremie("study STUDY.toml --out whole --quiet");
  test::shell("timeout -s KILL 0.15 '" TREMIE_PROGRAM "' study STUDY.toml --out cut --jobs 1",
              folder_.path());
  const auto result = tremie("study STUDY.toml --out cut --resume --quiet");
  EXPECT_EQ(result.code, 0) << result.text;
  EXPECT_EQ(csv("cut"), csv("whole"));
}

TEST_F(Study, SingleRowsCollectToTheSameTable) {
  tremie("study STUDY.toml --out whole --quiet");
  for (const int row : {0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11})
    ASSERT_EQ(tremie("study STUDY.toml --out rows --quiet --row " + std::to_string(row)).code, 0);
  const auto lost = tremie("study STUDY.toml --out rows --collect");
  EXPECT_EQ(lost.code, 3);
  EXPECT_NE(lost.text.find("1 of 12 rows are missing: 7"), std::string::npos) << lost.text;
  tremie("study STUDY.toml --out rows --quiet --row 7");
  EXPECT_EQ(tremie("study STUDY.toml --out rows --collect").code, 0);
  EXPECT_EQ(csv("rows"), csv("whole"));
}

TEST_F(Study, BadInputSaysWhereAndWritesNothing) {
  const auto study = test::read_file(folder_ / "STUDY.toml");
  const auto with = [&](const std::string& from, const std::string& to) {
    auto text = study;
    text.replace(text.find(from), from.size(), to);
    test::write_file(folder_ / "bad.toml", text);
    const auto result = tremie("study bad.toml --out bad");
    EXPECT_EQ(result.code, 2) << result.text;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "bad"));
    return result.text;
  };
  EXPECT_NE(with("mix.yield_stress", "mix.yeld_stress").find("mix.yield_stress"), std::string::npos);
  EXPECT_NE(with("\"20 Pa\"", "20").find("bad.toml:4"), std::string::npos);
  EXPECT_NE(with("\"20 Pa\"", "\"-20 Pa\"").find("out of range"), std::string::npos);
  EXPECT_NE(with("levels", "level").find("nearest: levels"), std::string::npos);
  EXPECT_NE(with("\"test.rest\"\nvalues = [\"0 s\", \"60 s\"]", "\"floor.coefficient\"\nvalues = [0.3, 0.4]")
                .find("no row of this study"),
            std::string::npos);
}

// A process that is killed is a finding of its own; those beside it come home.
TEST(Pool, AProcessThatDiesIsNamed) {
  const std::size_t items[] = {0, 1, 2, 3};
  std::vector<std::string> came(4);
  const bool whole = study::run_pool(
      items, 2,
      [](std::size_t i) {
        if (i == 2) raise(SIGSEGV);
        return std::string(200000, 'x') + std::to_string(i);  // more than a pipe holds
      },
      [&](const study::Finished& f) { came[f.item] = f.text ? f.text->substr(200000) : f.death; });
  EXPECT_TRUE(whole);
  EXPECT_EQ(came[0] + came[1] + came[3], "013");
  EXPECT_NE(came[2].find("signal 11"), std::string::npos);
}

// A run that was cut while it moved says so through the journal, and a journal without the word is read.
TEST(Row, KeepsThatItsConcreteStillMoved) {
  study::Row row{1, {500.0}, "completed", 0, {}, 1.0};
  EXPECT_FALSE(study::row_from_json(study::row_json(row), 1)->moving);
  row.moving = true;
  EXPECT_TRUE(study::row_from_json(study::row_json(row), 1)->moving);
}

TEST(Collect, ARowThatCameTwiceWithOtherResultsIsNamed) {
  study::Row row{1, {500.0}, "completed", 0, {}, 1.0};
  study::Row again = row;
  again.cpu = 2.0;
  EXPECT_TRUE(study::collect(2, {row, again}).problems.empty());
  again.readings = {501.0};
  EXPECT_EQ(study::collect(2, {row, again}).problems.size(), 1u);
  EXPECT_EQ(study::collect(2, {row}).missing, std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace tremie
