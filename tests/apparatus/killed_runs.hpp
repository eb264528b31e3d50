#pragma once

// Runs of the program that are killed at random moments and resumed, compared byte by byte with one that was not.

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie::test {

struct KilledScene {
  const char* name;
  const char* text;  ///< with a checkpoint at every few steps
  int threads = 1;
};

/// Each scheme, geometry and apparatus, so coarse that it is done within a second.
inline const std::vector<KilledScene> killed_scenes{{"cone", R"(apparatus = "slump_flow"
mix = "mix_a"
test = {rest = "60 s", duration = "1 s"}
model = {cell = "20 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s", frame_interval = "0.1 s"})"},
                                                    {"friction", R"(apparatus = "slump_flow"
mix = "mix_b"
test = {duration = "1 s"}
floor = {contact = "friction"}
model = {cell = "20 mm", points_per_cell = 2, transfer = "flip"}
output = {checkpoint_interval = "0.02 s"})"},
                                                    {"quarter", R"(apparatus = "slump_flow"
mix = "mix_a"
test = {duration = "0.4 s"}
model = {space = "quarter", cell = "25 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s", frame_interval = "0.1 s"})",
                                                     2},
                                                    {"explicit", R"(apparatus = "slump_flow"
mix = "mix_a"
test = {rest = "60 s", duration = "0.4 s"}
model = {space = "quarter", cell = "25 mm", points_per_cell = 2, scheme = "explicit", yield = "papanastasiou", regularisation = "0.2 s"}
output = {checkpoint_interval = "0.02 s", frame_interval = "0.05 s"})",
                                                     2},
                                                    {"paper", R"(apparatus = "slump_flow"
mix = "mix_c"
preset = "paper"
test = {duration = "0.1 s"}
model = {space = "quarter", cell = "25 mm"}
output = {checkpoint_interval = "0.02 s"})"},
                                                    {"couette", R"(apparatus = "icar_vane"
mix = "mix_a"
test = {rest = "60 s", speeds = ["0.5 rev/s", "0.1 rev/s"], pre_shear_time = "0.5 s", hold_time = "0.5 s", average_time = "0.2 s"}
model = {cell = "5 mm"}
output = {checkpoint_interval = "0.02 s", frame_interval = "0.2 s"})"},
                                                    {"vane", R"(apparatus = "icar_vane"
mix = "mix_a"
test = {duration = "0.5 s"}
model = {space = "plane", cell = "12 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s", frame_interval = "0.1 s"})"},
                                                    {"box", R"(apparatus = "l_box"
mix = "mix_a"
test = {duration = "1 s"}
model = {cell = "25 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s"})"},
                                                    {"box_in_space", R"(apparatus = "l_box"
mix = "mix_a"
test = {duration = "0.3 s"}
model = {space = "half", cell = "33 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s"})"}};

/// What the two results must agree in: all but what tells of time and cost.
inline std::map<std::string, std::string> bytes_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> bytes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const auto name = std::filesystem::relative(entry.path(), folder);
    const bool compared = name == "timeseries.csv" || name == "results.h5" || name == "scene.toml" ||
                          name == "frames.pvd" || name.extension() == ".vtp";
    if (entry.is_regular_file() && compared) bytes[name.string()] = read_file(entry.path());
  }
  return bytes;
}

class KilledRuns {
 public:
  explicit KilledRuns(unsigned seed) : random_(seed) {}

  /// Kills so many runs of the scene, many of them while a checkpoint is written: they follow each other closely. Returns how many were killed before they were done.
  int compare(const KilledScene& scene, int kills) {
    const TemporaryFolder folder;
    write_file(folder / "scene.toml", scene.text);
    run_ = {"run", "scene.toml", "--quiet", "--threads", std::to_string(scene.threads), "--out", "killed"};
    const auto begin = std::chrono::steady_clock::now();
    auto whole = run_;
    whole.back() = "whole";
    const int code = wait(start(whole, folder.path()));
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_TRUE(code == 0 || code == 3) << scene.name << ": " << code;
    int killed = 0;
    for (int i = 0; i < kills; ++i) killed += kill_one(folder.path(), wall) ? 1 : 0;
    while (next(folder.path()).front() == "resume") {
      if (const int end = wait(start(next(folder.path()), folder.path())); end != code) {
        ADD_FAILURE() << scene.name << ": resumed run ended with " << end << ": "
                      << read_file(folder / "errors.txt");
        break;
      }
    }
    if (!std::filesystem::exists(folder / "killed")) {
      EXPECT_EQ(wait(start(run_, folder.path())), code);
    }
    const auto expected = bytes_of(folder / "whole"), got = bytes_of(folder / "killed");
    EXPECT_EQ(expected.size(), got.size()) << scene.name;
    for (const auto& [name, bytes] : expected)
      EXPECT_TRUE(got.contains(name) && got.at(name) == bytes) << scene.name << ": " << name;
    EXPECT_FALSE(std::filesystem::exists(folder / ".killed.part")) << scene.name;
    return killed;
  }

 private:
  using Words = std::vector<std::string>;

  static pid_t start(const Words& arguments, const std::filesystem::path& folder) {
    Words words = arguments;
    words.insert(words.begin(), TREMIE_PROGRAM);
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder.c_str()) == 0 && freopen("errors.txt", "a", stderr)) execv(argv[0], argv.data());
    _exit(127);
  }
  static int wait(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  /// Goes on where there is a checkpoint, and from the start where there is none yet.
  Words next(const std::filesystem::path& folder) const {
    for (const char* at : {".killed.part", "killed"})
      if (std::filesystem::exists(folder / at / "checkpoint/state")) return {"resume", "killed", "--quiet"};
    return run_;
  }
  bool kill_one(const std::filesystem::path& folder, double wall) {
    if (std::filesystem::exists(folder / "killed/summary.json") && next(folder).front() == "run")
      return false;
    const pid_t child = start(next(folder), folder);
    std::this_thread::sleep_for(
        std::chrono::duration<double>(std::uniform_real_distribution(0.0, 0.9 * wall)(random_)));
    ::kill(child, std::bernoulli_distribution(0.8)(random_) ? SIGKILL : SIGINT);
    return wait(child) != 0;
  }

  std::mt19937 random_;
  Words run_;
};

}  // namespace tremie::test
