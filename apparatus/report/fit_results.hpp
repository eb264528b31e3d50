#pragma once

// The outcome of a fit as JSON.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rheometer/whole_fit/fit_record.hpp"

namespace tremie::report {

/// {"value", "ci95": [low, high] or null}, null where there is none.
nlohmann::ordered_json json_of(const std::optional<ParameterEstimate>& e);

template <class T>
nlohmann::ordered_json json_of(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// The values of one fit; null for a parameter that is not identifiable.
nlohmann::ordered_json fit_results(const FitResult& result);

/// "results" of a fit's summary.json; `records`: their names.
nlohmann::ordered_json fit_results(const RecordFits& fits, const std::vector<std::string>& records);

}  // namespace tremie::report
