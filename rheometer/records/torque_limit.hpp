#pragma once

// Whether a torque stands at the instrument's limit: a plateau at its largest value that is no slow maximum.

#include <optional>
#include <vector>

namespace tremie {

struct TorqueLimit {
  double torque = 0.0;  ///< [N m]
  long rows = 0;        ///< in a row that have it
};

/// `x` ascending: times, or speeds of a flow curve. Three or more values of x in a row have exactly the largest torque, and
/// the torque leaves it, to each side where it does, by 20 times its resolution within as many rows: a rounded maximum of a
/// smooth curve leaves it by up to nine times. Empty where there is no such plateau.
std::optional<TorqueLimit> torque_limit(const std::vector<double>& x, const std::vector<double>& torque);

}  // namespace tremie
