// What can happen to a program that writes a result: folders that go, files in the way, a reader that goes, signals,
// little memory. Exit code and message, the earlier result whole, nothing half-written.

#include <gtest/gtest.h>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

class SomeWorld : public ::testing::Test {
 protected:
  void SetUp() override {
    test::write_file(folder_ / "s.toml", R"(apparatus = "slump_flow"
mix = "mix_c"
test = {duration = "0.1 s", lift_speed = "instant"}
model = {cell = "20 mm", points_per_cell = 2}
output = {frames = false})");
  }
  test::Result tremie(const std::string& arguments, const std::string& before = "") {
    return test::shell(before + " env -u DISPLAY '" TREMIE_PROGRAM "' " + arguments, folder_.path());
  }
  /// Runs far longer than any test, does something to it, and returns how it ended.
  test::Result disturbed(const std::string& what, const std::string& options = "") {
    return test::shell("env -u DISPLAY '" TREMIE_PROGRAM
                       "' run s.toml --quiet --force --out out --set test.duration='1000 h' --set "
                       "model.time_step='1e-6 s' " +
                           options +
                           " & run=$!; until test -e .out.part/scene.toml; do sleep 0.02; done; sleep 0.1; " +
                           what + "; wait $run",
                       folder_.path());
  }
  bool holds(const test::Result& result, const std::string& words) {
    return result.text.find(words) != std::string::npos;
  }
  bool nothing_but(const std::string& name) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      if (entry.path().filename() != "s.toml" && entry.path().filename() != name) return false;
    return true;
  }

  test::TemporaryFolder folder_;
};

TEST_F(SomeWorld, AFolderRemovedUnderWay) {
  const auto result = disturbed("rm -r .out.part; kill -INT $run");
  EXPECT_EQ(result.code, 1) << result.text;
  EXPECT_TRUE(holds(result, "cannot be written") || holds(result, "was removed")) << result.text;
  EXPECT_TRUE(nothing_but("")) << result.text;
}

TEST_F(SomeWorld, AFileInTheWay) {
  test::write_file(folder_ / "out", "mine");
  for (const char* out : {"out", "out/deeper"}) {
    const auto result = tremie("run s.toml --force --quiet --out " + std::string(out));
    EXPECT_EQ(result.code, 2) << result.text;
    EXPECT_TRUE(holds(result, "/out")) << result.text;
  }
  EXPECT_EQ(test::read_file(folder_ / "out"), "mine");
  EXPECT_TRUE(nothing_but("out"));
}

// The result is there; that its summary on the screen is lost is said.
TEST_F(SomeWorld, NobodyReads) {
  for (const char* reader : {">&-", ">/dev/full", "| true"}) {
    const auto result = tremie("run s.toml --force --out out " + std::string(reader));
    EXPECT_TRUE(holds(result, "standard output cannot be written")) << reader << ": " << result.text;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/summary.json")) << reader;
  }
}

// Two at once are one: whoever ends a program often signals it and its group.
TEST_F(SomeWorld, SignalsKeepWhatThereIs) {
  for (const char* kill : {"kill -INT $run", "kill -TERM $run", "kill -INT $run; kill -INT $run"}) {
    const auto result = disturbed(kill);
    EXPECT_EQ(result.code, 130) << result.text;
    EXPECT_TRUE(holds({0, test::read_file(folder_ / "out/summary.json")}, "interrupted"));
    EXPECT_TRUE(nothing_but("out"));
  }
}

TEST_F(SomeWorld, LittleMemory) {
  for (const char* kilobytes : {"45000", "70000", "95000"}) {
    const auto result = tremie("run s.toml --quiet --force --out out --set model.cell='1 mm'",
                               "ulimit -v " + std::string(kilobytes) + ";");
    EXPECT_EQ(result.code, 1) << result.text;
    EXPECT_TRUE(holds(result, "not enough memory")) << result.text;
    EXPECT_FALSE(holds(result, "bad_alloc")) << result.text;
    EXPECT_TRUE(nothing_but(""));
  }
  // One thread: the allocator keeps 64 MB of addresses for each further one, which the estimate does not know.
  const auto told =
      tremie("run s.toml --quiet --threads 1 --out out --set model.cell='1 mm'", "ulimit -v 100000;");
  EXPECT_EQ(told.code, 2) << told.text;
  EXPECT_TRUE(holds(told, "--force")) << told.text;
}

}  // namespace
}  // namespace tremie
