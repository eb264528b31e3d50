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
  std::vector<std::optional<ParameterEstimate>> of_record;  ///< empty: it does not tell it, or it was given
  std::string where;  ///< of a protocol: the sections, "0.25 rev/s after 240 s"; empty: of the whole records
};

enum class Sign { not_negative, any };

/// The mean of one parameter; empty where no record tells it. The interval of one that is not negative starts at 0 at least.
std::optional<ReplicateMean> replicate_mean(const FitParameter& parameter,
                                            std::vector<std::optional<ParameterEstimate>> of_record,
                                            Sign sign = Sign::not_negative);

/// The parameters that at least one of the fits tells and was not given.
std::vector<ReplicateMean> replicate_means(const std::vector<FitResult>& fits);

}  // namespace tremie
