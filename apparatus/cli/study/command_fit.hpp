#pragma once

namespace CLI {
class App;
}

namespace tremie::cli {

/// tremie fit DATA.csv: material parameters from a torque record.
void add_command_fit(CLI::App& app, int& exit_code);

/// tremie read DATA.csv: what is understood of the record.
void add_command_read(CLI::App& app, int& exit_code);

}  // namespace tremie::cli
