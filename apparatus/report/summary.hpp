#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apparatus/common/outcome.hpp"

namespace tremie::report {

/// What summary.json holds.
nlohmann::ordered_json run_summary(const scene::Outcome& outcome);

/// summary.json.
std::string summary_json(const scene::Outcome& outcome);

/// timeseries.csv and its like: a column a quantity, empty fields where there is no value.
std::string columns_csv(const std::vector<scene::Column>& series);

/// "completed", "interrupted" or "failed".
const char* status_name(Status status);

}  // namespace tremie::report
