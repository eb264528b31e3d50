#include "apparatus/cli/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/run_files/glossary.hpp"
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
  return fmt::format("{} \"{}\"{} Allowed: {}", what, given, scene::did_you_mean(given, known),
                     joined(known));
}

struct Asked {
  const char *word, *answer;
};

/// What people ask for under another name: the command that does it.
constexpr std::array<Asked, 12> commands_asked{{
    {"invert",
     "tremie estimate goes from a slump flow to a mix, tremie calibrate from any measurements, tremie fit "
     "from a torque record"},
    {"sweep", "tremie study runs a scene over ranges of its keys"},
    {"scan", "tremie study runs a scene over ranges of its keys"},
    {"batch", "tremie study runs a scene many times"},
    {"optimise", "tremie calibrate finds the mix that meets measurements"},
    {"optimize", "tremie calibrate finds the mix that meets measurements"},
    {"plot", "every run leaves its charts as SVG, and report.html"},
    {"report", "every run leaves report.html; tremie compare makes one of several runs"},
    {"validate", "tremie check validates a scene; tremie verify measures the error"},
    {"diff", "tremie compare sets results side by side"},
    {"init", "tremie new prints a scene to start from"},
    {"help", "tremie --help, tremie COMMAND --help"},
}};
constexpr std::array<Asked, 6> options_asked{{
    {"--pdf", "report.html prints to two pages: open it in a browser and print it to a PDF"},
    {"--spread",
     "tremie estimate --spread \"590 mm\" goes from a slump flow to a mix, tremie calibrate from several"},
    {"--sweep", "tremie study runs a scene over ranges of its keys"},
    {"--range", "tremie study runs a scene over ranges of its keys"},
    {"--plot", "every run leaves its charts as SVG, and report.html"},
    {"--vtk", "every run leaves frames.pvd for ParaView (output.frames)"},
}};

template <std::size_t n>
std::string answer_to(const std::array<Asked, n>& asked, const std::string& word) {
  for (const auto& [name, answer] : asked)
    if (word == name) return fmt::format("; {}", answer);
  return {};
}

/// A first word that is no command.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
  if (std::find(commands.begin(), commands.end(), argv[1]) == commands.end())
    if (const std::string answer = answer_to(commands_asked, argv[1]); !answer.empty())
      throw scene::InputError(fmt::format("tremie: there is no command \"{}\"{}", argv[1], answer));
  if (std::find(commands.begin(), commands.end(), argv[1]) == commands.end())
    throw scene::InputError(unknown("tremie: there is no command", argv[1], commands));
}

/// An option that the command does not have; nothing where it is something else that was not expected.
void check_options(const CLI::App& app) {
  const CLI::App& at = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
  std::vector<std::string> options;
  for (const CLI::Option* option : at.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  const std::string command = &at == &app ? "tremie" : "tremie " + at.get_name();
  for (const std::string& given : app.remaining(true)) {
    const std::string word = given.substr(0, given.find('='));
    if (!word.starts_with('-') || word == "-") continue;
    const std::string answer = answer_to(options_asked, word);
    if (answer.empty()) throw scene::InputError(unknown(command + ": there is no option", word, options));
    throw scene::InputError(fmt::format("{}: there is no option \"{}\"{}", command, word, answer));
  }
  for (const std::string& word : app.remaining(true))
    if (!word.starts_with('-') && at.get_name() != "tremie")
      throw scene::InputError(fmt::format(
          "{}: \"{}\" is one argument too many; {}", command, word,
          word.find('=') != std::string::npos
              ? "each value has its own --set: --set KEY=VALUE --set KEY=VALUE"
              : "for several scenes call it for each and set the results side by side by tremie compare, or "
                "have tremie study run one scene over ranges"));
}

/// Control characters that came in with a file or an argument do nothing to the terminal.
std::string visible(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if ((code < 0x20 && c != '\n' && c != '\t') || code == 0x7f)
      shown += fmt::format("\\x{:02x}", code);
    else
      shown += c;
  }
  return shown;
}

/// A message of a person's size, whatever was put in.
std::string message(std::string_view text) {
  constexpr std::size_t most = 10000;
  return visible(text.substr(0, most)) + (text.size() > most ? " …" : "");
}

constexpr const char* invitation =
    R"(Tremie: virtual test apparatus for thixotropic fresh concrete

Slump flow of a mix, fresh or after four minutes of rest
  tremie new slump_flow > slump.toml; tremie run slump.toml --set test.rest="240 s"
Yield stress and viscosity from a slump flow, or from a torque record
  tremie estimate --spread "590 mm" --t500 "2.5 s"
  tremie fit torque.csv
L-box in space with two bars
  tremie new l_box > box.toml; tremie run box.toml --set model.space=half --set test.bars=2
Which keys matter, and which mix fits the measurements? Many runs, with intervals
  tremie study study.toml; tremie calibrate lab.toml
Numerical error, comparison of results, verification
  tremie run slump.toml --with-error --out runs/a; tremie compare runs/slump runs/a; tremie verify

A run writes report.html, curves and frames to runs/NAME. tremie COMMAND --help explains each command.
)";

/// The commands, "name TAB description" a line: what completions and man pages are made of.
void print_commands(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands({}))
    say("{}\t{}\n", command->get_name(), command->get_description());
}

/// What every apparatus reads, "apparatus TAB name TAB unit TAB words" a line: what the reference is made of.
void print_readings() {
  for (const scene::Apparatus& apparatus : scene::all_apparatus()) {
    say("{}\t\t\t{}\n", apparatus.keys.name, apparatus.words);
    for (const scene::Described& reading : apparatus.glossary)
      if (reading.is_result)
        say("{}\t{}\t{}\t{}\n", apparatus.keys.name, reading.name, report::unit_of(reading.name),
            report::words_of(reading.name, apparatus.keys.name));
  }
}

/// The columns of every apparatus' files, "apparatus TAB file TAB name TAB unit TAB words" a line.
void print_columns() {
  for (const scene::Apparatus& apparatus : scene::all_apparatus())
    for (const scene::Described& column : apparatus.glossary)
      if (!column.file.empty())
        say("{}\t{}\t{}\t{}\t{}\n", apparatus.keys.name, column.file, column.name,
            report::unit_of(column.name), report::words_of(column.name, apparatus.keys.name));
}

int parse_and_run(int argc, char** argv, const std::function<void(CLI::App&, int&)>& add) {
  CLI::App app{invitation, "tremie"};
  app.set_version_flag("--version", fmt::format("tremie {} ({}) for {}", version, commit, instructions));
  const auto lists = [&app](const char* option, const char* what, auto print) {
    const auto list = [print] {
      answer("");
      print();
      throw CLI::Success();
    };
    app.add_flag_callback(option, list, what)->group("");
  };
  lists("--commands", "List the commands for other programs", [&app] { print_commands(app); });
  lists("--readings", "List the readings for other programs", print_readings);
  lists("--columns", "List the columns of its files for other programs", print_columns);
  app.require_subcommand(1);
  int exit_code = done;
  add(app, exit_code);
  check_command(app, argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    const CLI::App& at = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
    check_options(app);
    say(stderr, "tremie{}{}: {}\n{}\n", &at == &app ? "" : " ", &at == &app ? "" : at.get_name(),
        error.what(), &at == &app ? "tremie --help shows what there is." : at.get_footer());
    return bad_input;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      check_options(app);
      return app.exit(error) == 0 ? done : bad_input;
    }
    std::ostringstream text;  // of --help and --version
    app.exit(error, text);
    answer(text.str());
    return done;
  }
  return exit_code;
}

}  // namespace

int run_program(int argc, char** argv, const std::function<void(CLI::App&, int&)>& add) {
  secure_streams();
  try {
    return exit_code_once_printed(parse_and_run(argc, argv, add), fault);
  } catch (const scene::InputError& error) {
    say(stderr, "{}\n", message(error.what()));
    return bad_input;
  } catch (const std::bad_alloc&) {
    say(stderr, "tremie: there is not enough memory: larger cells (model.cell) or fewer points_per_cell\n");
    return fault;
  } catch (const std::exception& error) {
    say(stderr, "tremie: {}\n", message(error.what()));
    return fault;
  }
}

}  // namespace tremie::cli
