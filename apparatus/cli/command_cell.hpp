#pragma once

namespace CLI {
class App;
}

namespace tremie::cli {

/// tremie cell HISTORY.toml: one material cell at a prescribed shear rate.
void add_command_cell(CLI::App& app, int& exit_code);

}  // namespace tremie::cli
