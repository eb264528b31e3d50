#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace tremie::cli {

/// Reads the command line with the commands that `add` adds, runs the one that is named there, and makes an
/// exit code (commands.hpp) of what leaves it.
int run_program(int argc, char** argv, const std::function<void(CLI::App&, int& exit_code)>& add);

/// A command of tremie-study, a program beside tremie: what fits and verifies needs libraries that would cost
/// every scene milliseconds to load.
struct StudyCommand {
  const char *name, *description;
};
inline constexpr StudyCommand read_command{
    "read", "Show how a rheometer's record is read: columns, units, sections, geometry"};
inline constexpr StudyCommand fit_command{
    "fit", "Fit material parameters, with their uncertainty, to a torque record"};
inline constexpr StudyCommand study_command{
    "study", "Run a scene many times by a design: which keys matter, and how much"};
inline constexpr StudyCommand calibrate_command{
    "calibrate", "Find the mix that fits measurements: parameters and forecasts, with intervals"};
inline constexpr StudyCommand verify_command{
    "verify", "Measure the numerical error against exact solutions, and its cost; write VERIFICATION.md"};

}  // namespace tremie::cli
