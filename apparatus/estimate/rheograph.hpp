#pragma once

// A rheograph for the wall: yield stress over plastic viscosity, with contours of slump flow and of t500.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/estimate/estimate.hpp"

namespace tremie::estimate {

struct NamedMix {
  std::string name;
  double tau_0 = 0.0, mu = 0.0;  ///< SI
};

using Line = std::vector<std::pair<double, double>>;  ///< (mu, tau_0), SI

/// Where the table's spread is `spread` [m]: a tau_0 for each node of mu that has one.
Line spread_contour(const SlumpTable& table, double spread);

/// Where the table's t500 is `t500` [s]: a mu for each node of tau_0 that has one.
Line t500_contour(const SlumpTable& table, double t500);

/// The table at its density as a chart: contours, the slump flows that are accepted for tremie concrete shaded, mixes, and
/// an estimate with its intervals.
std::string rheograph_svg(const SlumpTable& table, const std::vector<NamedMix>& mixes,
                          const std::optional<MixEstimate>& estimate);

}  // namespace tremie::estimate
