#include "apparatus/cli/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>

#include "apparatus/cli/commands.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/keys.hpp"
#include "tremie_version.hpp"

namespace tremie::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

/// What an argument that is not known could have been.
std::string unknown(const std::string& what, const std::string& given,
                    const std::vector<std::string>& known) {
  return fmt::format("{} \"{}\"; did you mean \"{}\"? Allowed: {}", what, given, scene::nearest(given, known),
                     joined(known));
}

/// A first word that is no command.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  if (std::find(commands.begin(), commands.end(), argv[1]) == commands.end())
    throw scene::InputError(unknown("tremie: there is no command", argv[1], commands));
}

/// An option that the command does not have; nothing where it is something else that was not expected.
void check_options(const CLI::App& app) {
  const CLI::App& at = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
  std::vector<std::string> options;
  for (const CLI::Option* option : at.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (const std::string& word : app.remaining(true))
    if (word.starts_with('-') && word != "-")
      throw scene::InputError(unknown(
          (&at == &app ? "tremie" : "tremie " + at.get_name()) + ": there is no option", word, options));
}

/// What was printed has arrived.
int flushed(int exit_code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  fmt::print(stderr, "tremie: the standard output cannot be written: {}\n", std::strerror(errno));
  return exit_code == done ? static_cast<int>(fault) : exit_code;
}

/// The commands, "name TAB description" a line: what completions and man pages are made of.
void print_commands(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands({}))
    fmt::print("{}\t{}\n", command->get_name(), command->get_description());
}

int parse_and_run(int argc, char** argv, const std::function<void(CLI::App&, int&)>& add) {
  CLI::App app{"Virtual test apparatus for thixotropic fresh concrete", "tremie"};
  app.set_version_flag("--version", fmt::format("tremie {} ({})", version, commit));
  const auto list = [&app] {
    print_commands(app);
    throw CLI::Success();
  };
  app.add_flag_callback("--commands", list, "List the commands for other programs")->group("");
  app.require_subcommand(1);
  int exit_code = done;
  add(app, exit_code);
  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) check_options(app);
    return app.exit(error) == 0 ? done : bad_input;
  }
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv, const std::function<void(CLI::App&, int&)>& add) {
  try {
    return flushed(parse_and_run(argc, argv, add));
  } catch (const scene::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return bad_input;
  } catch (const std::exception& error) {
    fmt::print(stderr, "tremie: {}\n", error.what());
    return fault;
  }
}

}  // namespace tremie::cli
