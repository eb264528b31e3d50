#pragma once

// A command of the program with its options, over CLI11. command.cpp alone includes CLI11's headers: they would cost
// each command's file six seconds of the processor's time to compile.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tremie::cli {

/// An option has two dashes before its name, a positional argument has none. What is not given keeps its value.
class Command {
 public:
  Command(CLI::App& program, const char* name, const char* description);

  /// An argument, or an option, that must be given.
  Command& required(const char* name, std::string& value, const std::string& meaning);
  Command& required(const char* name, std::vector<std::string>& values, const std::string& meaning);
  Command& option(const char* name, std::string& value, const std::string& meaning);
  Command& option(const char* name, std::vector<std::string>& values, const std::string& meaning);
  /// The help shows the value that it has.
  Command& option_with_default(const char* name, std::string& value, const std::string& meaning);
  /// One of these words.
  Command& choice(const char* name, std::string& value, const std::vector<std::string>& allowed,
                  const std::string& meaning);
  /// A whole number from `low` to `high`: an int, std::int64_t or std::size_t.
  template <class Integer>
  Command& number(const char* name, Integer& value, std::int64_t low, std::int64_t high,
                  const std::string& meaning);
  Command& flag(const char* name, bool& value, const std::string& meaning);
  /// Not together with these others, flags that are there already.
  Command& flag_without(const char* name, const std::vector<const char*>& others, bool& value,
                        const std::string& meaning);
  /// May be given several times, each with one value that is taken as it stands, brackets and all.
  Command& each(const char* name, std::vector<std::string>& values, const char* form,
                const std::string& meaning);
  /// --set KEY=VALUE, as often as wanted.
  Command& overrides(std::vector<std::string>& values);
  /// Takes whatever else is given, and does nothing with it.
  Command& anything();
  /// Stands below the help, and beside the message of what is missing.
  Command& example(const std::string& text);
  void run(const std::function<void()>& command);

 private:
  CLI::App* app_;
};

}  // namespace tremie::cli
