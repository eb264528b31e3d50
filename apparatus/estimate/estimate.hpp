#pragma once

// Yield stress and plastic viscosity from what a mould of concrete left at rest, spread, slump or both, and from its t500, by
// the table.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/estimate/slump_table.hpp"

namespace tremie::estimate {

/// SI; errors are one standard error. Spread or slump, or both.
struct Measured {
  std::optional<double> spread = {};  ///< at rest
  double spread_error = 0.015;
  std::optional<double> slump = {};
  double slump_error = 0.01;
  std::optional<double> t500 = {};
  double t500_error = 0.2;
  std::optional<double> mu = {};  ///< the plastic viscosity, where it is known [Pa s]
  double density = 2400.0;
};

struct Interval {
  double value = 0.0, low = 0.0, high = 0.0;  ///< the best fit (t500 or mu given) or the median; 95 %
};

struct MixEstimate {
  std::optional<Interval> tau_0,
      mu;  ///< empty where the table does not reach; mu also where neither t500 nor it is given
  std::optional<double> tau_0_thin_layer, tau_0_plug;  ///< closed forms, by the spread
  std::vector<std::string> reasons;                    ///< why it is not to be trusted
};

/// Throws scene::InputError for a reading that no concrete leaves in this mould, or that is not read with it, and where there
/// is neither spread nor slump.
void check_readings(const Measured& measured, const Mould& mould);

/// Every tau_0 and mu of the table is as likely as any other before the measurement, on log scales.
MixEstimate estimate(const SlumpTable& table, const Measured& measured);

}  // namespace tremie::estimate
