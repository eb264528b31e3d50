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
    "read", "Show what is understood of a rheometer's record: columns, units, sections, geometry"};
inline constexpr StudyCommand fit_command{
    "fit", "Material parameters, with their uncertainty, from a torque record"};
inline constexpr StudyCommand study_command{
    "study", "Run a scene many times, its keys changed by a design; what matters, and how much"};
inline constexpr StudyCommand calibrate_command{
    "calibrate", "From measurements to the mix: parameters and forecasts, with intervals"};
inline constexpr StudyCommand verify_command{
    "verify", "Measure the error against exact solutions, and what it costs; write VERIFICATION.md"};

}  // namespace tremie::cli
