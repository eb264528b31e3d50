// tremie run S.toml: runs a scene and fills a folder with its result.

#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <ctime>
#include <memory>
#include <sstream>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/process/brief_spin.hpp"
#include "apparatus/cli/progress.hpp"
#include "apparatus/cli/set_option.hpp"
#include "apparatus/registry/error_estimate.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/run_files/html.hpp"
#include "apparatus/report/run_files/result_files.hpp"
#include "apparatus/report/run_folder.hpp"

namespace tremie::cli {
namespace {

struct Options {
  std::string scene, out;
  std::vector<std::string> overrides;
  int threads = 0;  ///< 0: as many as pay
  bool quiet = false, force = false, with_error = false;
  std::string accuracy;  ///< "1 %"; empty: the scene's own cells
};

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

std::atomic<std::time_t> first_request{0};
static_assert(std::atomic<std::time_t>::is_always_lock_free, "set from a signal handler");

/// Whoever stops a program often signals it and its group: what comes at once is one request.
void request_stop(int signal_number) {
  const std::time_t now = std::time(nullptr);
  if (!stop_requested.exchange(true)) {
    first_request = now;
  } else if (now - first_request > 1) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
}

/// The first interrupt asks the run to stop and write what it has; one a second or two later ends the
/// program.
void stop_on_interrupt() {
  struct sigaction action = {};
  action.sa_handler = request_stop;
  action.sa_flags = SA_RESTART;
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int exit_code_of(const scene::Outcome& outcome) {
  if (outcome.status == Status::interrupted) return interrupted;
  return outcome.checks.reasons.empty() && outcome.status == Status::completed ? done : not_to_be_trusted;
}

void print_outcome(const scene::Scene& scene, const scene::Outcome& outcome) {
  for (const auto& line : outcome.lines) fmt::print("{}\n", line);
  if (const std::string line = report::measured_line(outcome); !line.empty())
    fmt::print("measured        {}\n", line);
  for (const auto& line : scene::error_lines(scene, outcome)) fmt::print("error           {}\n", line);
  const Checks& c = outcome.checks;
  fmt::print("checks          volume {:+.3g} %, mass {:.1e}, {} unconverged steps, {} points lost\n",
             100.0 * c.volume_change, c.mass_error, c.unconverged_steps, c.points_lost);
  const Cost& cost = outcome.cost;
  fmt::print("cost            {:.2f} s of CPU, {:.2f} s by the clock, {} steps, {} points, {:.0f} MB\n",
             cost.cpu, cost.wall, cost.steps, cost.points, static_cast<double>(cost.peak_rss_bytes) / 1e6);
  if (outcome.status == Status::interrupted) fmt::print("interrupted at {:.2f} s\n", cost.simulated);
}

void print_reasons(const scene::Outcome& outcome) {
  for (const auto& reason : outcome.checks.reasons) fmt::print(stderr, "not to be trusted: {}\n", reason);
}

/// The relative accuracy that was asked for: "1 %".
double accuracy_of(const std::string& text) {
  std::istringstream in(text);
  double percent = 0.0;
  std::string unit;
  const bool understood = (in >> percent >> unit) && unit == "%" && in.eof();
  if (!understood || !(percent >= 0.01 && percent <= 50.0))
    throw scene::InputError(fmt::format(
        "--accuracy: \"{}\" is not understood; it takes a percentage of 0.01 % to 50 %: \"1 %\"", text));
  return 0.01 * percent;
}

/// The scene with the cells that the accuracy wants; says the price first.
scene::Scene with_cells_for(const scene::Scene& scene, const Options& options) {
  scene::Observer observer;
  observer.interrupted = &stop_requested;
  const auto choice = scene::choose_cells(scene, accuracy_of(options.accuracy), observer);
  auto overrides = options.overrides;
  overrides.push_back(scene::cells_override(scene, choice.factor));
  if (!options.quiet)
    fmt::print("accuracy        {} wants {}, about {:.1f} s of CPU\n", options.accuracy, overrides.back(),
               choice.cpu);
  std::fflush(stdout);
  return scene::read(options.scene, overrides);
}

/// An accuracy that was not reached is said.
void note_accuracy(const Options& options, scene::Outcome& outcome) {
  if (options.accuracy.empty() || outcome.status != Status::completed) return;
  const auto& error = *outcome.error;
  if (error.bars.empty()) {
    outcome.checks.reasons.push_back("the accuracy cannot be judged: " + error.basis);
    return;
  }
  const auto* value = std::get_if<double>(scene::find_result(outcome, error.bars.front().name));
  const double reached = error.bars.front().error / std::abs(*value);
  if (reached > accuracy_of(options.accuracy))
    outcome.checks.reasons.push_back(fmt::format("the accuracy of {} was not reached: {} is good to {:.2g} %",
                                                 options.accuracy, error.bars.front().name, 100.0 * reached));
}

/// What repeats the run, to be typed where it was.
std::string command_of(const Options& options) {
  std::string text = "tremie run " + options.scene;
  for (const auto& change : options.overrides) text += " --set '" + change + "'";
  if (!options.accuracy.empty()) return text + " --accuracy '" + options.accuracy + "'";
  return options.with_error ? text + " --with-error" : text;
}

scene::Outcome run_and_write(const scene::Scene& scene, const Options& options,
                             const report::RunFolder& folder, std::vector<std::string>& notes) {
  report::ResultFiles files(folder.staging(), scene.resolved, command_of(options),
                            report::frames_written(scene.output));
  scene::Observer observer;
  observer.interrupted = &stop_requested;
  observer.on_frame = [&](const Frame& frame) { files.frame(frame); };
  scene::Outcome outcome;
  {
    ProgressLine line;
    if (!options.quiet) observer.on_progress = [&](const scene::Progress& progress) { line.show(progress); };
    outcome = scene::run(scene, observer);
    if (options.with_error || !options.accuracy.empty())
      outcome.error = scene::estimate_error(scene, outcome, observer);
  }
  note_accuracy(options, outcome);
  notes = files.finish(outcome);
  return outcome;
}

int threads_for(const scene::Scene& scene, const Options& options) {
  return options.threads > 0 ? options.threads : scene::default_threads(scene);
}

int run(const Options& options) {
  auto scene = scene::read(options.scene, options.overrides);
  if (!options.accuracy.empty()) accuracy_of(options.accuracy);
  const int threads = threads_for(scene, options);
  spin_briefly(threads);
  report::RunFolder folder(options.out.empty() ? "runs/" + scene.name : options.out, options.force);
  stop_on_interrupt();
  if (!options.accuracy.empty()) scene = with_cells_for(scene, options);
  scene::set_threads(scene, threads);
  std::vector<std::string> notes;
  const auto outcome = run_and_write(scene, options, folder, notes);
  folder.publish();
  print_reasons(outcome);
  if (!options.quiet) {
    print_outcome(scene, outcome);
    for (const auto& note : notes) fmt::print("note            {}\n", note);
    fmt::print("written to      {}\n", folder.target().string());
  }
  return exit_code_of(outcome);
}

}  // namespace

void add_command_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("run", "Run a scene and write its result");
  command->add_option("scene", options->scene, "Scene file (TOML)")->required();
  command->add_option("--out", options->out, "Folder for the result (default: runs/<scene name>)");
  add_set_option(*command, options->overrides);
  command->add_option("--threads", options->threads, "Threads (default: as many as pay for the scene's size)")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--with-error", options->with_error,
                    "Also run coarser cells, and state the discretisation error of the result");
  command->add_option(
      "--accuracy", options->accuracy,
      "Choose the cells for this accuracy, \"1 %\"; says the price first, implies --with-error");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->add_flag("--force", options->force, "Replace an earlier result in the folder");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace tremie::cli
