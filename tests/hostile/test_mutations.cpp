// 10,000 mutations of scenes and 2,000 of torque records, by fixed seeds (the unit test: 300 of both): each is read or
// refused with a message; a price is a number; what is cheap is run, and its results are numbers or it says why not;
// no more than 1 GB of memory, and none hangs.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

#include "apparatus/registry/cost_estimate.hpp"
#include "apparatus/registry/registry.hpp"
#include "rheometer/fits/fit.hpp"
#include "tests/apparatus/temporary_folder.hpp"
#include "tests/hostile/finite.hpp"
#include "tests/hostile/mutation.hpp"

namespace tremie {
namespace {

constexpr double most_memory = 1e9;    // [bytes]
constexpr double cheap = 0.2;          // [s] of CPU by its estimate
constexpr unsigned seconds_each = 30;  // then SIGALRM ends the test, whose last line names the mutation

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// What is wrong with a run that says nothing of it; empty: nothing.
std::string against(const scene::Outcome& outcome) {
  if (!outcome.checks.reasons.empty() || outcome.status == Status::interrupted) return {};
  if (outcome.status != Status::completed) return "did not complete and gives no reason";
  if (!is_finite(outcome.results)) return "a result is not finite";
  for (const auto& column : outcome.series)
    for (const double value : column.values)
      if (std::isinf(value)) return "infinite in " + column.name;
  return {};
}

/// How a scene ends: "refused", "dear", "run", ... or what is wrong, with "!" before it.
std::string ending_of(const std::string& text, int) try {
  const auto scene = scene::read_text(text, "mutated.toml");
  const auto estimate = scene::estimate(scene);
  if (!estimate) return "no points";
  const auto cost = scene::cost_of(scene, *estimate);
  if (!(std::isfinite(cost.cpu) && cost.cpu > 0.0 && std::isfinite(cost.memory) && estimate->steps >= 0))
    return "! a price that is no number";
  if (cost.cpu > cheap || cost.memory > 0.1 * most_memory) return "dear";
  std::atomic<bool> stop{false};
  const auto begin = std::chrono::steady_clock::now();
  scene::Observer observer;
  observer.interrupted = &stop;
  observer.on_progress = [&](const scene::Progress&) {
    stop = std::chrono::steady_clock::now() - begin > std::chrono::seconds(2);
  };
  const auto outcome = scene::run(scene, observer);
  if (const std::string wrong = against(outcome); !wrong.empty()) return "! " + wrong;
  return outcome.status == Status::interrupted ? "run, cut"
         : outcome.checks.reasons.empty()      ? "run"
                                               : "run, told";
} catch (const scene::InputError& error) {
  return std::string(error.what()).empty() ? "! no message" : "refused";
} catch (const std::exception& error) {
  return std::string("! ") + error.what();
}

template <class Ending>
void judge_all(const std::vector<std::string>& bases, int mutations, Ending ending) {
  std::map<std::string, int> ended;
  for (int i = 0; i < mutations; ++i) {
    test::Mutation mutation(static_cast<unsigned>(i));
    const std::string text = mutation(bases[static_cast<std::size_t>(i) % bases.size()]);
    alarm(seconds_each);
    const std::string how = ending(text, i);
    alarm(0);
    EXPECT_NE(how.front(), '!') << "mutation " << i << " " << how << ":\n" << text;
    ++ended[how];
  }
  for (const auto& [how, n] : ended) std::cout << n << " " << how << '\n';
  EXPECT_LT(peak_memory(), most_memory);
}

void judge_scenes(int mutations) {
  std::vector<std::string> bases;
  for (const auto& entry : std::filesystem::directory_iterator(TREMIE_SCENES)) {
    const std::string name = entry.path().filename();
    if (name.starts_with("cell")) continue;
    bases.push_back(test::read_file(entry.path()));
    // with every key, coarse and short, so that most can be run
    if (name.starts_with("bored_pile")) continue;  // it has no duration: it ends when it is full
    const bool narrow = name.starts_with("v_funnel") || name.starts_with("orimet");
    for (const char* cell : narrow ? std::array{"model.cell=10 mm", "model.cell=20 mm"}
                                   : std::array{"model.cell=25 mm", "model.cell=33 mm"}) {
      if (name.find("flow_curve") != std::string::npos || name.find("site") != std::string::npos ||
          name.starts_with("tribometer"))
        continue;
      std::vector<std::string> changes{cell, "test.duration=0.2 s"};
      if (name.starts_with("lcpc_box")) changes.push_back("test.pour_time=0.1 s");  // is within the duration
      bases.push_back(scene::read(entry.path(), changes).resolved);
    }
  }
  std::sort(bases.begin(), bases.end());
  judge_all(bases, mutations, ending_of);
}

TEST(Mutations, SomeScenes) { judge_scenes(120); }
TEST(Mutations, AllScenes) { judge_scenes(10000); }

/// A record is read and, every fifth one, fitted, or refused; a fit that is to be trusted has numbers.
std::string ending_of_record(const std::string& text, int i) try {
  const TorqueRecord record = parse_torque_record(text, "mutated.csv");
  if (record.torque.size() > 2000 || i % 5 != 0) return "read";
  FitInput input;
  input.omega = 1.57;
  input.rest = 240.0;
  const FitResult result = fit(record, input);
  const auto is_number = [](const std::optional<tremie::ParameterEstimate>& e) {
    return !e || std::isfinite(e->value);
  };
  const bool numbers = is_number(result.tau_0) && is_number(result.mu) && is_number(result.alpha) &&
                       is_number(result.lambda_0) && is_number(result.static_yield_stress);
  if (result.reasons.empty() && !(numbers && std::isfinite(result.scatter)))
    return "! a fit that is no number";
  return result.reasons.empty() ? "fitted" : "fitted, told";
} catch (const RecordError& error) {
  return "refused";
} catch (const std::invalid_argument& error) {
  return "refused by the fit";
} catch (const std::exception& error) {
  return std::string("! ") + error.what();
}

void judge_records(int mutations) {
  std::string curve = "speed_rev_per_s,torque_N_m\n", decay = "time_s,torque_N_m\n",
              other = "Zeit [s];Moment [mN.m]\n";
  for (int i = 1; i <= 12; ++i)
    curve += std::to_string(0.05 * i) + "," + std::to_string(0.9 + 1.4 * 0.05 * i) + "\n";
  for (int i = 0; i < 30; ++i) {
    decay += std::to_string(0.4 * i) + "," + std::to_string(1.25 + 0.75 * std::exp(-0.43 * 0.4 * i)) + "\n";
    other += std::to_string(i) + ";" + std::to_string(1250 + 750 * std::exp(-0.4 * i)) + "\n";
  }
  judge_all({curve, decay, other, test::read_file(TREMIE_REFERENCE_DATA "/site_torque/rebuilt.csv")},
            mutations, ending_of_record);
}

TEST(Mutations, SomeRecords) { judge_records(50); }
TEST(Mutations, AllRecords) { judge_records(2000); }

}  // namespace
}  // namespace tremie
