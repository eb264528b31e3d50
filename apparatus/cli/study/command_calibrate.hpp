#pragma once

namespace CLI {
class App;
}

namespace tremie::cli {

/// tremie calibrate LAB.toml
void add_command_calibrate(CLI::App& app, int& exit_code);

}  // namespace tremie::cli
