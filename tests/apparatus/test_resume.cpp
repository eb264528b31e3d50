// A run that was killed goes on from its checkpoint to the bytes of one that was not; what is not whole is refused.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>

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

/// The folder of a scene, with the program's runs of it in folders of their own.
class Longer {
 public:
  explicit Longer(const std::string& name) {
    for (const test::KilledScene& scene : test::killed_scenes)
      if (scene.name == name) test::write_file(folder_ / "scene.toml", scene.text);
  }
  test::Result run(const std::string& out, const std::string& duration) const {
    return tremie("run scene.toml --quiet --out " + out +
                  (duration.empty() ? "" : " --set test.duration='" + duration + "'"));
  }
  test::Result resume(const std::string& out, const std::string& until) const {
    return tremie("resume " + out + " --quiet --until '" + until + "'");
  }
  std::map<std::string, std::string> bytes(const std::string& out) const {
    return test::bytes_of(folder_ / out);
  }
  void add_to(const std::string& file, const std::string& text) const {
    test::write_file(folder_ / file, test::read_file(folder_ / file) + text);
  }

 private:
  test::Result tremie(const std::string& words) const {
    return test::shell("'" TREMIE_PROGRAM "' " + words, folder_.path());
  }
  test::TemporaryFolder folder_;
};

// A run that is over goes on to a later end, and again to a later one, as if it had been asked for at once: the end that it
// had has shortened no step of it.
TEST(Resume, AFinishedRunGoesOnToTheBytesOfALongerOne) {
  for (const char* name : {"cone", "explicit", "box"}) {
    const Longer folder(name);
    const auto whole = folder.run("whole", "0.5 s");
    EXPECT_TRUE(whole.code == 0 || whole.code == 3) << name << whole.text;
    const auto brief = folder.run("longer", "0.3 s");
    EXPECT_TRUE(brief.code == 0 || brief.code == 3) << name << brief.text;
    for (const char* until : {"0.4 s", "0.5 s"}) {
      const auto longer = folder.resume("longer", until);
      EXPECT_TRUE(longer.code == 0 || longer.code == 3) << name << longer.text;
    }
    EXPECT_TRUE(folder.bytes("whole") == folder.bytes("longer")) << name;
  }
}

// What is no later end of the test is refused, and the result stays as it was.
TEST(Resume, RefusesWhatIsNoLaterEnd) {
  const Longer box("box");
  box.run("out", "0.3 s");
  const auto before = box.bytes("out");
  for (const auto& [until, why] : {std::pair{"0.2 s", "no later than the end of the run"},
                                   {"0.3 s", "no later than the end of the run"},
                                   {"300", "unit"},
                                   {"300 mm", "mm"},
                                   {"-3 s", "not greater than 0"}}) {
    const auto refused = box.resume("out", until);
    EXPECT_EQ(refused.code, 2) << refused.text;
    EXPECT_NE(refused.text.find("--until"), std::string::npos) << refused.text;
    EXPECT_NE(refused.text.find(why), std::string::npos) << refused.text;
  }
  EXPECT_EQ(box.resume("nowhere", "1 s").code, 2);
  EXPECT_TRUE(box.bytes("out") == before);
  // A scene that was edited is named, and no other process is.
  box.add_to("out/scene.toml", "# mine\n");
  const auto edited = box.resume("out", "1 s");
  EXPECT_EQ(edited.code, 2);
  EXPECT_NE(edited.text.find("scene.toml"), std::string::npos) << edited.text;
  EXPECT_EQ(edited.text.find("another process"), std::string::npos) << edited.text;
  const Longer vane("couette");
  vane.run("out", "");
  const auto schedule = vane.resume("out", "10 s");
  EXPECT_EQ(schedule.code, 2);
  EXPECT_NE(schedule.text.find("its schedule"), std::string::npos) << schedule.text;
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

TEST_F(Refused, ALongerTestOfAnUnfinishedRunNamesResume) {
  const auto longer = tremie("'" TREMIE_PROGRAM "' resume out --until '200 s'");
  EXPECT_EQ(longer.code, 2);
  EXPECT_NE(longer.text.find("`tremie resume out` first"), std::string::npos) << longer.text;
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
