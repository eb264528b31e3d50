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

std::vector<std::string> known_names() {
  std::vector<std::string> names;
  for (const auto& apparatus : scene::all_apparatus()) names.push_back(apparatus.keys.name);
  return names;
}

std::string template_of(const std::string& name) {
  for (const auto& apparatus : scene::all_apparatus())
    if (apparatus.keys.name == name) return scene::write_template(apparatus.keys);
  const std::vector<std::string> known = known_names();
  throw scene::InputError(fmt::format("new: \"{}\" is not available{} Available: {}", name,
                                      scene::did_you_mean(name, known), fmt::join(known, ", ")));
}

}  // namespace

void add_command_new(CLI::App& app, int& exit_code) {
  auto name = std::make_shared<std::string>();
  Command command(app, "new", "Print a commented scene to start from");
  command.required("apparatus", *name, fmt::format("One of: {}", fmt::join(known_names(), ", ")));
  command.example("tremie new slump_flow > slump.toml; tremie run slump.toml");
  command.run([name, &exit_code] {
    answer(template_of(*name));
    exit_code = done;
  });
}

}  // namespace tremie::cli
