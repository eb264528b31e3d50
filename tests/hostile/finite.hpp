#pragma once

#include <cmath>
#include <variant>
#include <vector>

#include "apparatus/common/outcome.hpp"

namespace tremie {

/// Whether every number among the results is finite.
inline bool is_finite(const std::vector<scene::Result>& results) {
  for (const auto& [name, value] : results) {
    if (const auto* number = std::get_if<double>(&value); number && !std::isfinite(*number)) return false;
    if (const auto* below = std::get_if<std::vector<scene::Result>>(&value); below && !is_finite(*below))
      return false;
  }
  return true;
}

}  // namespace tremie
