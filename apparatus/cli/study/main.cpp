// The program `tremie-study`: fits, studies and verification, as `tremie fit` and its like call it.

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/cli/study/command_fit.hpp"

int main(int argc, char** argv) {
  return tremie::cli::run_program(argc, argv, [](CLI::App& app, int& exit_code) {
    tremie::cli::add_command_fit(app, exit_code);
    tremie::cli::add_command_read(app, exit_code);
    tremie::cli::add_command_study(app, exit_code);
    tremie::cli::add_command_calibrate(app, exit_code);
    tremie::cli::add_command_verify(app, exit_code);
  });
}
