#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "apparatus/cli/command_cell.hpp"
#include "apparatus/cli/command_fit.hpp"
#include "apparatus/cli/commands.hpp"
#include "apparatus/scene/input_error.hpp"
#include "tremie_version.hpp"

namespace {

int run(int argc, char** argv) {
  CLI::App app{"Virtual test apparatus for thixotropic fresh concrete", "tremie"};
  app.set_version_flag("--version", fmt::format("tremie {} ({})", tremie::version, tremie::commit));
  app.require_subcommand(1);
  int exit_code = tremie::cli::done;
  tremie::cli::add_command_run(app, exit_code);
  tremie::cli::add_command_check(app, exit_code);
  tremie::cli::add_command_new(app, exit_code);
  tremie::cli::add_command_cell(app, exit_code);
  tremie::cli::add_command_fit(app, exit_code);
  tremie::cli::add_command_verify(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? tremie::cli::done : tremie::cli::bad_input;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const tremie::scene::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return tremie::cli::bad_input;
  } catch (const std::exception& error) {
    fmt::print(stderr, "tremie: {}\n", error.what());
    return tremie::cli::fault;
  }
}
