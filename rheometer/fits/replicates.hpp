#pragma once

// Fits of several records of one material side by side.

#include <optional>
#include <string>
#include <vector>

#include "rheometer/fits/fit.hpp"

namespace tremie {

/// One parameter over the records that tell it.
struct ReplicateMean {
  std::string name, unit;         ///< key without the unit: "yield_stress"
  int records = 0;                ///< that tell it
  Estimate mean;                  ///< interval by the scatter between the records; none for one record
  std::optional<double> between;  ///< standard deviation between the records, relative to the mean
  std::optional<double>
      within;  ///< what the single fits' intervals promise, as a relative standard deviation
  std::optional<double>
      laboratories;  ///< relative scatter of one paste between laboratories (Haist et al. 2020), where it is known
};

/// The parameters that at least one of the fits tells and was not given.
std::vector<ReplicateMean> replicate_means(const std::vector<FitResult>& fits);

/// What a fit tells of a parameter.
const std::optional<Estimate>& value_of(const FitResult& fit, const ReplicateMean& parameter);

}  // namespace tremie
