#pragma once

#include <string>
#include <vector>

#include "apparatus/cli/options/command.hpp"

namespace tremie::cli {

/// --set KEY=VALUE, as often as wanted.
void add_set_option(Command& command, std::vector<std::string>& overrides);

}  // namespace tremie::cli
