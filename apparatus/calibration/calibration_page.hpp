#pragma once

// A calibration as a page: what the measurements tell, how well they are met, what is forecast.

#include <string>

#include "apparatus/calibration/calibrate.hpp"

namespace tremie::calibration {

/// report.html. `input` is the laboratory's file as it stands; `command` repeats the calibration.
std::string calibration_html(const Lab& lab, const Calibration& calibration, const std::string& input,
                             const std::string& command);

}  // namespace tremie::calibration
