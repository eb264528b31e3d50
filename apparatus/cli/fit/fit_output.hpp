#pragma once

// The outcome of a fit as lines for the screen.

#include <optional>
#include <string>
#include <vector>

#include "rheometer/whole_fit/fit_record.hpp"

namespace tremie::cli {

void print_estimate(const std::string& name, const std::optional<ParameterEstimate>& e,
                    const std::string& unit);

/// "Pa.s^n".
std::string unit_on_screen(const FitParameter& parameter);

void print_fits(const RecordFits& fits, const std::vector<std::string>& records);

}  // namespace tremie::cli
