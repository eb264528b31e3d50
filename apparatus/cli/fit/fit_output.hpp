#pragma once

// The outcome of a fit as lines for the screen.

#include <nlohmann/json.hpp>
#include <optional>

#include "apparatus/report/fit_results.hpp"

namespace tremie::cli {

using Json = nlohmann::ordered_json;

using report::json_of;

void print_estimate(const char* name, const std::optional<Estimate>& e, const char* unit);
void print_result(const FitResult& result);

}  // namespace tremie::cli
