#pragma once

// Linear interpolation in tables whose keys are sorted.

#include <cmath>
#include <iterator>
#include <optional>

namespace tremie::detail {

/// A number that round-off leaves where the table's is.
inline double rounded(double x) { return std::round(1e9 * x) * 1e-9; }

/// Linear between the neighbours of x, `value` of an entry what is interpolated; empty outside.
template <class Map, class Value>
std::optional<double> between(const Map& map, double x, Value value) {
  auto above = map.lower_bound(x);
  if (above == map.end()) return std::nullopt;
  if (above->first == x) return value(above->second);
  if (above == map.begin()) return std::nullopt;
  const auto below = std::prev(above);
  const std::optional<double> a = value(below->second), b = value(above->second);
  if (!a || !b) return std::nullopt;
  const double share = (x - below->first) / (above->first - below->first);
  return *a + share * (*b - *a);
}

}  // namespace tremie::detail
