#pragma once

// The fit of a record that a vane with blades has made.

#include "rheometer/fits/fit.hpp"
#include "rheometer/vane/vane_blades.hpp"

namespace tremie {

struct VaneFit {
  FitResult fit;  ///< of the cylinder's torques
  double least_factor = 1.0,
         most_factor = 1.0;  ///< torque of the blades over the cylinder's, over the record
};

/// fit() of the torques that the cylinder would have taken (torque_of_cylinder()). They hang on the viscosity: where the
/// input gives none, that of the fit before is taken until it stays. Throws std::invalid_argument as fit() and
/// blade_factor() do, and for a record that tells no viscosity.
VaneFit fit_with_blades(const TorqueRecord& record, const FitInput& input, const BladeTable& table);

}  // namespace tremie
