#pragma once

// One file a command, each with one function that adds it to the program. A command sets exit_code in its
// callback; scene::InputError may leave the callback (main.cpp makes it exit code 2), any other exception is
// a fault of ours (1).

namespace CLI {
class App;
}

namespace tremie::cli {

inline constexpr int done = 0;
inline constexpr int fault = 1;
inline constexpr int bad_input = 2;
inline constexpr int not_to_be_trusted = 3;
inline constexpr int interrupted = 130;

void add_command_run(CLI::App& app, int& exit_code);
void add_command_resume(CLI::App& app, int& exit_code);
void add_command_watch(CLI::App& app, int& exit_code);
void add_command_check(CLI::App& app, int& exit_code);
void add_command_new(CLI::App& app, int& exit_code);
void add_command_cell(CLI::App& app, int& exit_code);
void add_command_compare(CLI::App& app, int& exit_code);
void add_command_estimate(CLI::App& app, int& exit_code);
void add_command_study(CLI::App& app, int& exit_code);
void add_command_calibrate(CLI::App& app, int& exit_code);
void add_command_verify(CLI::App& app, int& exit_code);

}  // namespace tremie::cli
