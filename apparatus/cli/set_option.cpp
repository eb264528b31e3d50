#include "apparatus/cli/set_option.hpp"

#include <CLI/CLI.hpp>

namespace tremie::cli {

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
  // A callback for each, because CLI11 would split a value in brackets into several.
  command
      .add_option_function<std::vector<std::string>>(
          "--set", [&overrides](const std::vector<std::string>& values) { overrides = values; },
          "KEY=VALUE over the scene, KEY dotted, VALUE as TOML: --set mix.yield_stress=\"61 Pa\"")
      ->allow_extra_args(false)
      ->take_all()
      ->type_name("KEY=VALUE");
}

}  // namespace tremie::cli
