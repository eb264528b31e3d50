#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rheometer/fits/fit.hpp"

namespace tremie::report {

/// "results" of a fit's summary.json; null for what the record does not tell.
nlohmann::ordered_json fit_results(const FitResult& result);

}  // namespace tremie::report
