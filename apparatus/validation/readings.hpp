#pragma once

// Readings of scenes with the error of their cells and steps, several scenes at a time.

#include <string>
#include <vector>

#include "apparatus/validation/validation.hpp"

namespace tremie::validation {

struct Ask {
  std::string scene;   ///< TOML
  std::string result;  ///< "spread_mm"
  std::vector<std::string> overrides = {};
  bool with_error = true;
};

struct Reading {
  double value = 0.0;  ///< not-a-number where the run has no such number
  double error = 0.0;  ///< half-width, from three grids, one finer where coarse ones scatter
};

/// In the order of `asked`. Throws Interrupted.
std::vector<Reading> read_scenes(const std::vector<Ask>& asked, const Settings& settings);

}  // namespace tremie::validation
