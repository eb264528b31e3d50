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
  std::string name;
  std::string text;  ///< with a checkpoint at every few steps
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
                                                    {"funnel", R"(apparatus = "inverted_cone"
mix = "mix_a"
test = {rest = "60 s", duration = "1 s"}
model = {cell = "20 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s", frame_interval = "0.1 s"})"},
                                                    {"pour", R"(apparatus = "bored_pile"
mix = "mix_a"
pile = {radius = "0.3 m", depth = "1 m"}
pipe = {inner_radius = "75 mm", outer_radius = "82 mm", embedment = ["0.2 m", "0.4 m"], pull = "0.2 m", start = "0.15 m", above = "1 m"}
test = {rate = "20 m3/h"}
load = [{volume = "0.1 m3"}, {volume = "0.15 m3"}]
model = {cell = "50 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s"})"},
                                                    {"box_in_space", R"(apparatus = "l_box"
mix = "mix_a"
test = {duration = "0.3 s"}
model = {space = "half", cell = "33 mm", points_per_cell = 2}
output = {checkpoint_interval = "0.02 s"})"}};

/// Explicit steps by both precisions, transfers and orders of a step, on one thread and on two.
inline const std::vector<KilledScene> killed_explicit_scenes = [] {
  std::vector<KilledScene> scenes;
  for (const char* words : {R"(scheme = "explicit")", R"(scheme = "explicit", transfer = "flip")",
                            R"(scheme = "explicit_usf", precision = "double", transfer = "flip")",
                            R"(scheme = "explicit_usf", precision = "single")",
                            R"(scheme = "explicit_usf", precision = "double", shape = "gimp")",
                            R"(scheme = "explicit_usf", transfer = "flip")"})
    for (const int threads : {1, 2})
      scenes.push_back({words,
                        std::string(R"(apparatus = "slump_flow"
mix = "mix_a"
test = {rest = "60 s", duration = "0.3 s"}
output = {checkpoint_interval = "0.01 s", frame_interval = "0.05 s"}
model = {space = "quarter", cell = "25 mm", points_per_cell = 2, yield = "papanastasiou", regularisation = "0.2 s", )") +
                            words + "}",
                        threads});
  return scenes;
}();

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

/// Kills runs of scenes and resumes them; each that comes to its end is compared with one that was left alone.
class KilledRuns {
 public:
  explicit KilledRuns(unsigned seed) : random_(seed) {}

  /// So many kills of one scene, in runs one after the other.
  void kill(const KilledScene& scene, int kills) {
    const TemporaryFolder folder;
    folder_ = folder.path(), name_ = scene.name + ", " + std::to_string(scene.threads) + " threads";
    write_file(folder_ / "scene.toml", scene.text);
    run_ = {"run", "scene.toml", "--quiet", "--threads", std::to_string(scene.threads), "--out", "killed"};
    auto alone = run_;
    alone.back() = "whole";
    const auto begin = Clock::now();
    code_ = wait(start(alone));
    wall_ = std::chrono::duration<double>(Clock::now() - begin).count();
    ASSERT_TRUE(code_ == 0 || code_ == 3) << name_ << ": " << read_file(folder_ / "errors.txt");
    whole_ = bytes_of(folder_ / "whole");
    int done = 0;
    for (int tried = 0; done < kills && tried < 6 * kills; ++tried) done += kill_one() ? 1 : 0;
    while (!is_done()) {
      if (const int end = wait(start(next())); end != code_) {
        ADD_FAILURE() << name_ << ": ended with " << end << ": " << read_file(folder_ / "errors.txt");
        return;
      }
    }
    compare();
  }
  /// Kills by what the run was doing, as its folder tells.
  const std::map<std::string, int>& moments() const { return moments_; }
  int killed() const {
    int sum = 0;
    for (const auto& [moment, n] : moments_) sum += n;
    return sum;
  }

 private:
  using Words = std::vector<std::string>;
  using Clock = std::chrono::steady_clock;

  pid_t start(const Words& arguments) const {
    Words words = arguments;
    words.insert(words.begin(), TREMIE_PROGRAM);
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder_.c_str()) == 0 && freopen("errors.txt", "a", stderr)) execv(argv[0], argv.data());
    _exit(127);
  }
  static int code_of(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status); }
  static int wait(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return code_of(status);
  }
  bool has(const char* name) const { return std::filesystem::exists(folder_ / name); }
  bool is_unfinished() const {
    return has(".killed.part/checkpoint/state") || has("killed/checkpoint/state");
  }
  bool is_done() const { return has("killed/summary.json") && !is_unfinished(); }
  /// Goes on where there is a checkpoint, and from the start where there is none yet.
  Words next() const { return is_unfinished() ? Words{"resume", "killed", "--quiet"} : run_; }

  void compare() const {
    const auto got = bytes_of(folder_ / "killed");
    EXPECT_EQ(whole_.size(), got.size()) << name_;
    for (const auto& [name, bytes] : whole_)
      EXPECT_TRUE(got.contains(name) && got.at(name) == bytes) << name_ << ": " << name;
    EXPECT_FALSE(has(".killed.part")) << name_;
  }

  /// What a killed run was at.
  std::string moment() const {
    if (has(".killed.part/checkpoint/state.part")) return "writing a checkpoint";
    if (has(".killed.part/checkpoint.copy")) return "taking over a checkpoint";
    if (has(".killed.part/timeseries.csv")) return "writing the result";
    if (has(".killed.part/checkpoint/state")) return "between two checkpoints";
    if (has("killed/checkpoint/state")) return "interrupted, or before it took over";
    return "before the first checkpoint";
  }

  /// Waits for a random time and, in half of the cases, for a file that is being written then. Whether the run was
  /// killed: one that came to its end is compared, and the next begins anew.
  bool kill_one() {
    if (is_done()) {
      compare();
      std::filesystem::remove_all(folder_ / "killed");
    }
    const pid_t child = start(next());
    const std::chrono::duration<double> delay(std::uniform_real_distribution(0.0, 0.7 * wall_)(random_));
    std::this_thread::sleep_for(delay);
    static constexpr const char* written[] = {".killed.part/checkpoint/state.part",
                                              ".killed.part/checkpoint/state.part",
                                              ".killed.part/timeseries.csv"};
    const char* file = std::bernoulli_distribution(0.5)(random_)
                           ? written[std::uniform_int_distribution(0, 2)(random_)]
                           : nullptr;
    int status = 0;
    while (file && !has(file)) {
      if (waitpid(child, &status, WNOHANG) == child) return ended(code_of(status));
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    ::kill(child, file || std::bernoulli_distribution(0.9)(random_) ? SIGKILL : SIGINT);
    const int code = wait(child);
    if (code == -SIGKILL || code == 130) return ++moments_[moment()], true;
    return ended(code);
  }
  bool ended(int code) {
    EXPECT_EQ(code, code_) << name_ << ": " << read_file(folder_ / "errors.txt");
    return false;
  }

  std::mt19937 random_;
  std::filesystem::path folder_;
  std::string name_;
  Words run_;
  int code_ = 0;       ///< of the run that was left alone
  double wall_ = 0.0;  ///< its time [s]
  std::map<std::string, std::string> whole_;
  std::map<std::string, int> moments_;
};

}  // namespace tremie::test
