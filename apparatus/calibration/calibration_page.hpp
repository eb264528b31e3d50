#pragma once

// A calibration as a page: what the measurements tell, how well they are met, what is forecast.

#include <string>

#include "apparatus/calibration/next_test.hpp"

namespace tremie::calibration {

/// report.html. `advice` may be empty. `input` is the laboratory's file as it stands; `command` repeats the calibration.
std::string calibration_html(const Lab& lab, const Calibration& calibration,
                             const std::vector<Advice>& advice, const std::string& input,
                             const std::string& command);

}  // namespace tremie::calibration
