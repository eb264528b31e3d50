#pragma once

// The outcome of a fit as JSON and as lines for the screen.

#include <nlohmann/json.hpp>
#include <optional>

#include "rheometer/fits/fit.hpp"

namespace tremie::cli {

using Json = nlohmann::ordered_json;

/// {"value", "ci95": [low, high] or null}, null where there is none.
Json json_of(const std::optional<Estimate>& e);

template <class T>
Json json_of(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json results_json(const FitResult& result);

void print_estimate(const char* name, const std::optional<Estimate>& e, const char* unit);
void print_result(const FitResult& result);

}  // namespace tremie::cli
