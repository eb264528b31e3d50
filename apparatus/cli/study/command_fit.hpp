#pragma once

namespace CLI {
class App;
}

namespace tremie::cli {

/// tremie fit DATA.csv: material parameters from a torque record.
void add_command_fit(CLI::App& app, int& exit_code);

}  // namespace tremie::cli
