// tremie run S.toml and tremie cell S.toml: run a scene and fill a folder with its result.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <thread>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/brief_spin.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/process/stop_signals.hpp"
#include "apparatus/cli/run/run_and_write.hpp"
#include "apparatus/registry/cost_estimate.hpp"
#include "apparatus/registry/error_estimate.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/report/run_folder.hpp"

namespace tremie::cli {
namespace {

struct RunOptions {
  std::string scene, out;
  std::vector<std::string> overrides;
  int threads = 0;  ///< 0: as many as pay
  bool quiet = false, json = false, force = false, with_error = false, crate = false;
  std::string accuracy;  ///< "1 %"; empty: the scene's own cells
};

/// The scene with the cells that the accuracy wants; says the price first.
scene::Scene with_cells_for(const scene::Scene& scene, const RunOptions& options) {
  scene::Observer observer;
  observer.interrupted = &stop_requested;
  const auto choice = scene::choose_cells(scene, accuracy_of(options.accuracy), observer);
  auto overrides = options.overrides;
  overrides.push_back(scene::cells_override(scene, choice.factor));
  if (!options.quiet && !options.json)
    say("accuracy        {} wants {}, about {:.1f} s of CPU\n", options.accuracy, overrides.back(),
        choice.cpu);
  std::fflush(stdout);
  return scene::read(options.scene, overrides);
}

/// What repeats the run, to be typed where it was.
std::string command_of(const RunOptions& options) {
  std::string text = "tremie run " + options.scene;
  for (const auto& change : options.overrides) text += " --set '" + change + "'";
  if (!options.accuracy.empty()) return text + " --accuracy '" + options.accuracy + "'";
  return options.with_error ? text + " --with-error" : text;
}

/// Threads beyond the processors only wait for each other; many more there cannot be.
void check_threads(int threads) {
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (threads > std::max(64, 4 * processors))
    throw scene::InputError(fmt::format("--threads {}: this machine has {} processors; allowed: at most {}",
                                        threads, processors, std::max(64, 4 * processors)));
}

/// Said once the program has started anew, if it does.
void note_threads(int threads) {
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (threads > processors)
    say(stderr, "note: --threads {} on {} processors: slower than --threads {}\n", threads, processors,
        processors);
}

int threads_for(const scene::Scene& scene, const RunOptions& options) {
  check_threads(options.threads);
  return options.threads > 0 ? options.threads : scene::default_threads(scene);
}

report::RunFolder folder_of(const RunOptions& options, const scene::Scene& scene) {
  return {options.out.empty() ? "runs/" + scene.name : options.out, options.force, scene.files};
}

int run_cell(const RunOptions& options) {
  const auto scene = scene::read(options.scene, options.overrides, "cell");
  say_notes(scene, screen_of(options.quiet, options.json));
  const HeldInterrupts held;  // outlives the folder
  report::RunFolder folder = folder_of(options, scene);
  return run_and_publish(scene,
                         {.name = scene.name,
                          .resolved = scene.resolved,
                          .command = "tremie cell " + options.scene,
                          .crate = options.crate},
                         screen_of(options.quiet, options.json), folder);
}

int run_scene(const RunOptions& options) {
  auto scene = scene::read(options.scene, options.overrides);
  if (!options.accuracy.empty()) accuracy_of(options.accuracy);
  const int threads = threads_for(scene, options);
  spin_briefly(threads);
  if (!options.quiet) note_threads(options.threads);
  report::RunFolder folder = folder_of(options, scene);
  stop_on_interrupt();
  say_notes(scene, screen_of(options.quiet, options.json));
  if (!options.accuracy.empty()) scene = with_cells_for(scene, options);
  if (!options.force) scene::check_cost(scene, threads);
  scene::set_threads(scene, threads);
  return run_and_publish(scene,
                         {.name = scene.name,
                          .resolved = scene.resolved,
                          .command = command_of(options),
                          .accuracy = options.accuracy,
                          .with_error = options.with_error,
                          .crate = options.crate,
                          .threads = threads},
                         screen_of(options.quiet, options.json), folder);
}

}  // namespace

void add_command_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  Command command(app, "run", "Run a scene and write its result");
  command.required("scene", options->scene, "Scene file (TOML)");
  command.option("--out", options->out, "Folder for the result (default: runs/<scene name>)");
  command.overrides(options->overrides);
  command.number("--threads", options->threads, 1, 1024, "Threads (default: chosen by the scene's size)");
  command.flag("--with-error", options->with_error,
               "Also run coarser cells, and state the discretisation error");
  command.option("--accuracy", options->accuracy,
                 "Choose the cells for this accuracy, \"1 %\"; states the cost first, implies --with-error");
  add_crate_option(command, options->crate);
  add_json_option(command, options->json);
  command.flag("--quiet", options->quiet, "Print nothing but errors");
  command.flag("--force", options->force, "Replace an earlier result in the folder");
  command.example(
      "tremie new slump_flow > slump.toml writes a scene to start from; tremie run slump.toml runs it,\n"
      "with --set test.rest=\"240 s\" after four minutes of rest. Bundled mixes: mix = \"mix_a\", mix_b, "
      "mix_c.");
  command.run([options, &exit_code] { exit_code = run_scene(*options); });
}

void add_command_cell(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunOptions>();
  Command command(app, "cell", "Compute the law alone, in one material cell at a prescribed shear rate");
  command.required("scene", options->scene, "Scene file (TOML) with apparatus = \"cell\"");
  command.option("--out", options->out, "Folder for the result (default: runs/<scene name>)");
  command.overrides(options->overrides);
  command.number("--threads", options->threads, 1, 1024, "Threads; a cell needs one");
  add_crate_option(command, options->crate);
  add_json_option(command, options->json);
  command.flag("--quiet", options->quiet, "Print nothing but errors");
  command.flag("--force", options->force, "Replace an earlier result in the folder");
  command.example(
      "tremie new cell > cell.toml writes a history to start from; tremie cell cell.toml runs it.");
  command.run([options, &exit_code] { exit_code = run_cell(*options); });
}

}  // namespace tremie::cli
