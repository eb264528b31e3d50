#include "apparatus/cli/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "apparatus/cli/commands.hpp"
#include "apparatus/scene/input_error.hpp"
#include "tremie_version.hpp"

namespace tremie::cli {
namespace {

int parse_and_run(int argc, char** argv, const std::function<void(CLI::App&, int&)>& add) {
  CLI::App app{"Virtual test apparatus for thixotropic fresh concrete", "tremie"};
  app.set_version_flag("--version", fmt::format("tremie {} ({})", version, commit));
  app.require_subcommand(1);
  int exit_code = done;
  add(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? done : bad_input;
  }
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv, const std::function<void(CLI::App&, int&)>& add) {
  try {
    return parse_and_run(argc, argv, add);
  } catch (const scene::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return bad_input;
  } catch (const std::exception& error) {
    fmt::print(stderr, "tremie: {}\n", error.what());
    return fault;
  }
}

}  // namespace tremie::cli
