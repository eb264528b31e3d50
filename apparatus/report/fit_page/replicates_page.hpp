#pragma once

// Fits of several records of one material as one page: the records over each other, their parameters beside the mean,
// and how they scatter.

#include <string>
#include <vector>

#include "rheometer/whole_fit/fit_record.hpp"

namespace tremie::report {

/// report.html. `records`: the files; `command` repeats the fits.
std::string replicates_html(const RecordFits& fits, const std::vector<std::string>& records,
                            const std::string& command);

}  // namespace tremie::report
