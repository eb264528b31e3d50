// tremie check S.toml: validates, shows the resolved scene, what it carries and what it would cost.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/set_option.hpp"
#include "apparatus/registry/registry.hpp"

namespace tremie::cli {
namespace {

struct Options {
  std::string scene;
  std::vector<std::string> overrides;
};

void print_estimate(const scene::Estimate& e) {
  fmt::print(
      "\n# cost, estimated\n#   {} points, {} bytes a point\n#   {} active cells at the start\n#   about {} "
      "steps\n",
      e.points, e.bytes_per_point, e.cells_active, e.steps);
}

void check(const Options& options) {
  const auto scene = scene::read(options.scene, options.overrides, "");
  const auto estimate = scene::estimate(scene);  // refuses what the apparatus cannot run
  fmt::print("# {}: valid. Every value that it uses, in SI:\n\n{}", options.scene, scene.resolved);
  fmt::print("\n# used and left out\n");
  for (const auto& line : scene::uses(scene)) fmt::print("#   {}\n", line);
  for (const auto& note : scene.notes) fmt::print("# note: {}\n", note);
  if (estimate) print_estimate(*estimate);
}

}  // namespace

void add_command_check(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("check", "Validate a scene; print it resolved, what it uses and what it costs");
  command->add_option("scene", options->scene, "Scene file (TOML)")->required();
  add_set_option(*command, options->overrides);
  command->callback([options, &exit_code] {
    check(*options);
    exit_code = done;
  });
}

}  // namespace tremie::cli
