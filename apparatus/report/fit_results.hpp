#pragma once

// The outcome of a fit as JSON.

#include <nlohmann/json.hpp>
#include <optional>

#include "rheometer/fits/fit.hpp"

namespace tremie::report {

/// {"value", "ci95": [low, high] or null}, null where there is none.
nlohmann::ordered_json json_of(const std::optional<Estimate>& e);

template <class T>
nlohmann::ordered_json json_of(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// "results" of a fit's summary.json; null for what the record does not tell.
nlohmann::ordered_json fit_results(const FitResult& result);

}  // namespace tremie::report
