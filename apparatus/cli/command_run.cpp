// tremie run S.toml: runs a scene and fills a folder with its result.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/set_option.hpp"
#include "apparatus/scene/scene.hpp"

namespace tremie::cli {
namespace {

struct Options {
  std::string scene, out;
  std::vector<std::string> overrides;
  int threads = 1;
  bool quiet = false, force = false;
};

int exit_code_of(const scene::Outcome& outcome) {
  if (outcome.status == Status::interrupted) return interrupted;
  return outcome.checks.reasons.empty() && outcome.status == Status::completed ? done : not_to_be_trusted;
}

int run(const Options& options) {
  auto scene = scene::read(options.scene, options.overrides);
  scene::set_threads(scene, options.threads);
  const auto outcome = scene::run(scene);
  for (const auto& line : outcome.lines) fmt::print("{}\n", line);
  return exit_code_of(outcome);
}

}  // namespace

void add_command_run(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("run", "Run a scene and write its result");
  command->add_option("scene", options->scene, "Scene file (TOML)")->required();
  command->add_option("--out", options->out, "Folder for the result (default: runs/<scene name>)");
  add_set_option(*command, options->overrides);
  command->add_option("--threads", options->threads, "Threads")->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->add_flag("--force", options->force, "Replace an earlier result in the folder");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace tremie::cli
