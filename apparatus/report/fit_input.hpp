#pragma once

// What a fit was asked for: its options read from text, and written again as JSON and as the command that repeats it.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "rheometer/whole_fit/fit_options.hpp"

namespace tremie::report {

/// "--vane-radius" of vane_radius.
std::string command_name(const FitOption& option);

/// Sets a number from text with a unit, or a word. `name` stands for the option in messages. Throws scene::InputError.
void read_option(FitOptions& options, const FitOption& option, const std::string& name,
                 const std::string& text);

/// What repeats a fit of these files, to be typed where it was. `texts`: the options' as they were given, in the order of
/// fit_options(), empty for none; of a flag anything.
std::string fit_command(const std::vector<std::string>& records, const std::vector<std::string>& texts);

/// "input" of a fit's summary.json: what it was told, the defaults included, so that it can be repeated.
nlohmann::ordered_json fit_input(const FitOptions& options, const std::vector<std::string>& records);

}  // namespace tremie::report
