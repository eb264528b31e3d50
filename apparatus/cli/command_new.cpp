// tremie new APPARATUS: prints a commented scene to start from.

#include <fmt/format.h>

#include <memory>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/resolved.hpp"

namespace tremie::cli {
namespace {

std::string template_of(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& apparatus : scene::all_apparatus()) {
    if (apparatus.keys.name == name) return scene::write_template(apparatus.keys);
    known.push_back(apparatus.keys.name);
  }
  throw scene::InputError(fmt::format("new: \"{}\" is not available{} Available: {}", name,
                                      scene::did_you_mean(name, known), fmt::join(known, ", ")));
}

}  // namespace

void add_command_new(CLI::App& app, int& exit_code) {
  auto name = std::make_shared<std::string>();
  Command command(app, "new", "Print a commented scene to start from");
  command.required("apparatus", *name, "slump_flow, l_box, icar_vane or cell");
  command.example(
      "tremie new slump_flow > slump.toml; also l_box, icar_vane, cell. Then tremie run slump.toml.");
  command.run([name, &exit_code] {
    answer(template_of(*name));
    exit_code = done;
  });
}

}  // namespace tremie::cli
