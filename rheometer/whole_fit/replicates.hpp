#pragma once

// Fits of several records of one material side by side.

#include <optional>
#include <string>
#include <vector>

#include "rheometer/fits/parameters.hpp"

namespace tremie {

/// One parameter over the records that tell it.
struct ReplicateMean {
  FitParameter parameter;
  int records = 0;         ///< that tell it
  ParameterEstimate mean;  ///< interval by the scatter between the records, not narrower than any of theirs
  std::optional<double> between;  ///< standard deviation between the records, relative to the mean
  std::optional<double>
      within;  ///< what the single fits' intervals promise, as a relative standard deviation
};

/// The parameters that at least one of the fits tells and was not given.
std::vector<ReplicateMean> replicate_means(const std::vector<FitResult>& fits);

}  // namespace tremie
