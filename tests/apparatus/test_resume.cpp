// A run that was killed goes on from its checkpoint to the bytes of one that was not; what is not whole is refused.

#include <gtest/gtest.h>

#include "tests/apparatus/killed_runs.hpp"

namespace tremie {
namespace {

// One kill in each of the apparatus and in explicit steps; 100 kills: test_resume_slow.
TEST(Resume, KilledRunsEndWithTheSameBytes) {
  test::KilledRuns runs(1);
  for (const test::KilledScene& scene : test::killed_scenes)  // the others: test_resume_slow.cpp
    if (scene.name == "cone" || scene.name == "explicit" || scene.name == "couette" || scene.name == "box")
      runs.kill(scene, 1);
  EXPECT_EQ(runs.killed(), 4);
}

class Refused : public ::testing::Test {
 protected:
  void SetUp() override {
    test::write_file(folder_ / "scene.toml", test::killed_scenes.front().text);
    // Interrupted by itself after a while: a run of seconds, in a group of its own, that gets SIGINT.
    const auto run =
        tremie("(sleep 0.4; kill -INT $$) & exec '" TREMIE_PROGRAM
               "' run scene.toml --set 'test.duration=\"100 s\"' --set 'model.cell=\"4 mm\"' --out out");
    ASSERT_EQ(run.code, 130) << run.text;
    ASSERT_TRUE(std::filesystem::exists(folder_ / "out/checkpoint/state"));
  }
  test::Result tremie(const std::string& command) {
    return test::shell("sh -c \"" + escaped(command) + "\"", folder_.path());
  }
  static std::string escaped(const std::string& command) {
    std::string text;
    for (const char c : command)
      text += (c == '"' || c == '$' || c == '\\') ? std::string("\\") + c : std::string(1, c);
    return text;
  }
  void expect_refused(const std::string& why) {
    const auto before = test::read_file(folder_ / "out/checkpoint/state");
    const auto result = tremie("'" TREMIE_PROGRAM "' resume out");
    EXPECT_EQ(result.code, 2) << result.text;
    EXPECT_NE(result.text.find(why), std::string::npos) << result.text;
    EXPECT_EQ(test::read_file(folder_ / "out/checkpoint/state"), before);
    EXPECT_FALSE(std::filesystem::exists(folder_ / ".out.part"));
  }
  void change_state(std::size_t at) {
    auto bytes = test::read_file(folder_ / "out/checkpoint/state");
    bytes.at(at < bytes.size() ? at : bytes.size() - 100) ^= 1;
    test::write_file(folder_ / "out/checkpoint/state", bytes);
  }

  test::TemporaryFolder folder_;
};

TEST_F(Refused, WhatIsDamagedCutOrOfAnotherScene) {
  change_state(1000);
  expect_refused("damaged or cut");
  change_state(1000);
  test::write_file(folder_ / "out/scene.toml", "apparatus = \"slump_flow\"");
  expect_refused("another scene");
  std::filesystem::resize_file(folder_ / "out/checkpoint/state", 500);
  expect_refused("damaged or cut");
}

TEST_F(Refused, ARunOverAnUnfinishedOneNamesResume) {
  const auto again = tremie("'" TREMIE_PROGRAM "' run scene.toml --out out");
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.text.find("tremie resume"), std::string::npos) << again.text;
}

TEST_F(Refused, TwoRunsIntoOneFolder) {
  const auto both = tremie("'" TREMIE_PROGRAM
                           "' run scene.toml --quiet --set 'test.duration=\"100 s\"' --set 'model.cell=\"3 "
                           "mm\"' --out two & sleep 0.3; '" TREMIE_PROGRAM
                           "' run scene.toml --out two; code=$?; kill -KILL $!; exit $code");
  EXPECT_EQ(both.code, 2) << both.text;
  EXPECT_NE(both.text.find("another process"), std::string::npos) << both.text;
}

}  // namespace
}  // namespace tremie
