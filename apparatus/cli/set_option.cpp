#include "apparatus/cli/set_option.hpp"

namespace tremie::cli {

void add_set_option(Command& command, std::vector<std::string>& overrides) {
  command.each("--set", overrides, "KEY=VALUE",
               "KEY=VALUE over the scene, KEY dotted, VALUE as TOML: --set mix.yield_stress=\"61 Pa\"");
}

}  // namespace tremie::cli
