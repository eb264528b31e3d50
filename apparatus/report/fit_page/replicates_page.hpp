#pragma once

// Fits of several records of one material as one page, from plain data: the records over each other, their parameters
// beside the mean, and how they scatter.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/report/fit_page/fit_page.hpp"

namespace tremie::report {

/// A parameter over the records that tell it; scatters are relative standard deviations.
struct MeanParameter {
  std::string words, unit, key;
  double mean = 0.0;
  std::optional<double> low = {}, high = {};  ///< 95 % of the mean
  int records = 0;
  std::optional<double> between = {}, within = {}, laboratories = {};
  std::vector<std::optional<double>> values = {};  ///< of each record; empty where it does not tell
};

struct ReplicatesReport {
  std::vector<FitReport> fits;
  std::vector<MeanParameter> means;
  std::vector<std::string> reasons;
  std::string command;  ///< repeats the fits
};

/// report.html.
std::string replicates_html(const ReplicatesReport& report);

}  // namespace tremie::report
