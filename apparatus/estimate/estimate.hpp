#pragma once

// Yield stress and plastic viscosity from a slump flow and its t500, by the table.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/estimate/slump_table.hpp"

namespace tremie::estimate {

/// SI; errors are one standard error.
struct Measured {
  double spread = 0.0, spread_error = 0.015;
  std::optional<double> t500 = {};
  double t500_error = 0.2;
  double density = 2400.0;
};

struct Interval {
  double value = 0.0, low = 0.0, high = 0.0;  ///< the best fit (t500 given) or the median; 95 %
};

struct MixEstimate {
  std::optional<Interval> tau_0, mu;  ///< empty where the table does not reach; mu also without t500
  double tau_0_thin_layer = 0.0, tau_0_plug = 0.0;  ///< closed forms
  std::vector<std::string> reasons;                 ///< why it is not to be trusted
};

/// Every tau_0 and mu of the table is as likely as any other before the measurement, on log scales.
MixEstimate estimate(const SlumpTable& table, const Measured& measured);

}  // namespace tremie::estimate
