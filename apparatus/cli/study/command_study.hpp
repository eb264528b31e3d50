#pragma once

namespace CLI {
class App;
}

namespace tremie::cli {

/// tremie study STUDY.toml
void add_command_study(CLI::App& app, int& exit_code);

}  // namespace tremie::cli
