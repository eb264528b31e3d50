#include "apparatus/cli/command_cell.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cell/cell.hpp"
#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/set_option.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/report/run_files/result_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {
namespace {

struct Options {
  std::string scene, out;
  std::vector<std::string> overrides;
  int threads = 1;
  bool quiet = false, json = false, force = false;
};

std::vector<std::string> write(const cell::Scene& scene, const scene::Outcome& outcome,
                               const std::string& command, const std::filesystem::path& folder) {
  report::ResultFiles files(folder, scene.resolved, command);
  std::vector<std::string> notes = files.finish(outcome);
  io::write_text(folder / "summary.json", summary_of(outcome).dump(2) + "\n");
  return notes;
}

int run(const Options& options) {
  const Stopwatch watch;
  const scene::Scene read = scene::read(options.scene, options.overrides, "cell");
  const auto& scene = *std::any_cast<cell::Scene>(&read.test);
  const CellResult result = cell::run(scene);
  const HeldInterrupts held;  // outlives the folder
  report::RunFolder folder(options.out.empty() ? "runs/" + scene.name : options.out, options.force);
  scene::Outcome outcome = cell::outcome(scene, result);
  watch.stop(outcome.cost);
  const std::vector<std::string> notes =
      write(scene, outcome, "tremie cell " + options.scene, folder.staging());
  folder.publish();
  for (const auto& reason : outcome.checks.reasons) fmt::print(stderr, "not to be trusted: {}\n", reason);
  if (options.json) print_result_as_json(folder.target(), notes);
  if (!options.quiet && !options.json) {
    for (const auto& line : outcome.lines) fmt::print("{}\n", line);
    for (const auto& note : notes) fmt::print("note                 {}\n", note);
    fmt::print("written to           {}\n", folder.target().string());
  }
  return outcome.checks.reasons.empty() ? done : not_to_be_trusted;
}

}  // namespace

void add_command_cell(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  Command command(app, "cell", "Run the law alone, in one material cell at a prescribed shear rate");
  command.required("scene", options->scene, "Scene file (TOML) with apparatus = \"cell\"");
  command.option("--out", options->out, "Folder for the result (default: runs/<scene name>)");
  add_set_option(command, options->overrides);
  command.number("--threads", options->threads, 1, 1024, "Threads; a cell needs one");
  add_json_option(command, options->json);
  command.flag("--quiet", options->quiet, "Print nothing but errors");
  command.flag("--force", options->force, "Replace an earlier result in the folder");
  command.example(
      "tremie new cell > cell.toml writes a history to start from; tremie cell cell.toml runs it.");
  command.run([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace tremie::cli
