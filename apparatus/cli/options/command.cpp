#include "apparatus/cli/options/command.hpp"

#include <CLI/CLI.hpp>

namespace tremie::cli {

namespace {

/// `--t500 ""`, as a script leaves it whose variable is empty, is no option that was left out.
const CLI::Validator not_empty(
    [](const std::string& given) {
      return given.empty() ? std::string("is empty: give a value") : std::string();
    },
    "", "not empty");

/// `--json=5`: CLI11 reads a number behind a flag as how often it was given.
const CLI::Validator no_value(
    [](const std::string& given) {
      return given == "true" ? std::string() : "takes no value, but has \"" + given + "\"";
    },
    "", "no value");

}  // namespace

Command::Command(CLI::App& program, const char* name, const char* description)
    : app_(program.add_subcommand(name, description)) {}

Command& Command::required(const char* name, std::string& value, const std::string& meaning) {
  app_->add_option(name, value, meaning)->required()->check(not_empty);
  return *this;
}

Command& Command::required(const char* name, std::vector<std::string>& values, const std::string& meaning) {
  app_->add_option(name, values, meaning)->required()->check(not_empty);
  return *this;
}

Command& Command::option(const char* name, std::string& value, const std::string& meaning) {
  app_->add_option(name, value, meaning)->check(not_empty);
  return *this;
}

Command& Command::option(const char* name, std::vector<std::string>& values, const std::string& meaning) {
  app_->add_option(name, values, meaning)->check(not_empty);
  return *this;
}

Command& Command::option_with_default(const char* name, std::string& value, const std::string& meaning) {
  app_->add_option(name, value, meaning)->capture_default_str()->check(not_empty);
  return *this;
}

Command& Command::choice(const char* name, std::string& value, const std::vector<std::string>& allowed,
                         const std::string& meaning) {
  app_->add_option(name, value, meaning)->check(CLI::IsMember(allowed));
  return *this;
}

template <class Integer>
Command& Command::number(const char* name, Integer& value, std::int64_t low, std::int64_t high,
                         const std::string& meaning) {
  app_->add_option(name, value, meaning)->check(CLI::Range(low, high));
  return *this;
}

template Command& Command::number(const char*, int&, std::int64_t, std::int64_t, const std::string&);
template Command& Command::number(const char*, std::int64_t&, std::int64_t, std::int64_t, const std::string&);
template Command& Command::number(const char*, std::size_t&, std::int64_t, std::int64_t, const std::string&);

Command& Command::flag(const char* name, bool& value, const std::string& meaning) {
  app_->add_flag(name, value, meaning)->check(no_value);
  return *this;
}

Command& Command::flag_without(const char* name, const std::vector<const char*>& others, bool& value,
                               const std::string& meaning) {
  CLI::Option* flag = app_->add_flag(name, value, meaning)->check(no_value);
  for (const char* other : others) flag->excludes(app_->get_option(other));
  return *this;
}

Command& Command::each(const char* name, std::vector<std::string>& values, const char* form,
                       const std::string& meaning) {
  // A callback, because CLI11 would split a value in brackets into several.
  app_->add_option_function<std::vector<std::string>>(
          name, [&values](const std::vector<std::string>& given) { values = given; }, meaning)
      ->allow_extra_args(false)
      ->take_all()
      ->type_name(form);
  return *this;
}

Command& Command::overrides(std::vector<std::string>& values) {
  return each("--set", values, "KEY=VALUE",
              "Replace a value of the scene: --set mix.yield_stress=\"61 Pa\"; may be repeated");
}

Command& Command::anything() {
  app_->allow_extras();
  return *this;
}

Command& Command::example(const std::string& text) {
  app_->footer(text);
  return *this;
}

void Command::run(const std::function<void()>& command) { app_->callback(command); }

}  // namespace tremie::cli
