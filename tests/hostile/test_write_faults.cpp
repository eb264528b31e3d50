// Each write of a run fails in turn, by itself or as on a disk that stays full: the run ends with a message that says
// where and why, or says what it left out; an earlier result stays whole, and nothing half-written stays.

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <map>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

using Files = std::map<std::string, std::string>;

Files files_in(const std::filesystem::path& folder) {
  Files files;
  if (!std::filesystem::exists(folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder)] = test::read_file(entry.path());
  return files;
}

/// Without what `tremie resume --until` goes on from: like a checkpoint, a run does without where it cannot be written.
std::size_t files_of_the_result(const Files& files) {
  return static_cast<std::size_t>(std::count_if(
      files.begin(), files.end(), [](const auto& file) { return !file.first.starts_with(".for_longer"); }));
}

struct Fault {
  int error;
  bool stays;  ///< every later write fails, too
  const char* words;
};

class WriteFaults : public ::testing::Test {
 protected:
  void SetUp() override {
    test::write_file(folder_ / "scene.toml", R"(apparatus = "l_box"
mix = "mix_a"
test = {duration = "0.2 s"}
model = {cell = "50 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.001 s", frame_interval = "0.1 s"})");
    std::filesystem::create_directory(folder_ / "results");
    const auto first = run("", "");
    code_ = first.code;
    ASSERT_TRUE(code_ == 0 || code_ == 3) << first.text;
    earlier_ = files_in(folder_ / "results/out");
    run("TREMIE_FAIL_COUNT='" + (folder_ / "count").string() + "'", "--force");
    writes_ = std::atol(test::read_file(folder_ / "count").c_str());
    ASSERT_GT(writes_, 50);
    earlier_ = files_in(folder_ / "results/out");
  }
  test::Result run(const std::string& environment, const std::string& options) {
    return test::shell(environment + " TREMIE_FAIL_IN='" + (folder_ / "results").string() +
                           "' LD_PRELOAD='" TREMIE_FAILING_WRITES "' '" TREMIE_PROGRAM
                           "' run scene.toml --quiet --threads 1 --out '" +
                           (folder_ / "results/out").string() + "' " + options,
                       folder_.path());
  }
  test::Result run_with(const Fault& fault, long at, const std::string& options) {
    return run("TREMIE_FAIL_AT=" + std::to_string(at) + " TREMIE_FAIL_WITH=" + std::to_string(fault.error) +
                   " TREMIE_FAIL_ON=" + (fault.stays ? "1" : "0"),
               options);
  }
  /// What the failed write leaves: told, and nothing of the run that ended by it.
  void judge(const test::Result& result, const Fault& fault, long at, const Files& before) {
    const std::string what = std::string(fault.words) + (fault.stays ? ", stays" : "") + " at write " +
                             std::to_string(at) + ": exit " + std::to_string(result.code) + ", " +
                             result.text;
    const Files now = files_in(folder_ / "results/out");
    if (result.code == code_) {
      EXPECT_EQ(files_of_the_result(now), files_of_the_result(earlier_)) << what;
      for (const auto& name : {"timeseries.csv", "results.h5", "frames.pvd", "scene.toml"})
        EXPECT_TRUE(now.contains(name) && now.at(name) == earlier_.at(name)) << what << ": " << name;
    } else {
      EXPECT_TRUE(result.code == 1 || result.code == 2) << what;
      EXPECT_NE(result.text.find("results/"), std::string::npos) << what;  // the file
      EXPECT_TRUE(result.text.find(fault.words) != std::string::npos ||
                  result.text.find("cannot be written") != std::string::npos)
          << what;
      EXPECT_TRUE(now == before) << what;
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "results"))
      if (entry.path().filename() != "out") {
        EXPECT_TRUE(std::filesystem::exists(entry.path() / "checkpoint/state"))
            << what << ": left " << entry.path();
        EXPECT_NE(result.code, code_) << what << ": left " << entry.path();
      }
  }
  /// Every `stride`-th write, over an earlier result and into a new folder.
  void fail_each(long stride) {
    const Fault faults[] = {{ENOSPC, true, "No space left on device"}, {EIO, false, "Input/output error"}};
    std::map<int, int> ended;
    for (const Fault& fault : faults)
      for (long at = 1; at <= writes_; at += stride)
        for (const bool over : {true, false}) {
          if (!over) std::filesystem::remove_all(folder_ / "results/out");
          const auto before = files_in(folder_ / "results/out");
          const auto result = run_with(fault, at, over ? "--force" : "");
          judge(result, fault, at, before);
          ++ended[result.code];
          restore();
        }
    for (const auto& [code, n] : ended) RecordProperty("exit_" + std::to_string(code), n);
  }
  void restore() {
    std::filesystem::remove_all(folder_ / "results");
    for (const auto& [name, bytes] : earlier_) {
      std::filesystem::create_directories((folder_ / "results/out" / name).parent_path());
      test::write_file(folder_ / "results/out" / name, bytes);
    }
  }

  test::TemporaryFolder folder_;
  int code_ = 0;
  long writes_ = 0;
  Files earlier_;
};

TEST_F(WriteFaults, Some) { fail_each(std::max(1L, writes_ / 8)); }
TEST_F(WriteFaults, All) { fail_each(1); }

}  // namespace
}  // namespace tremie
