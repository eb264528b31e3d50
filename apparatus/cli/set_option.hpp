#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tremie::cli {

/// --set KEY=VALUE, as often as wanted.
void add_set_option(CLI::App& command, std::vector<std::string>& overrides);

}  // namespace tremie::cli
