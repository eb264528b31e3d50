#pragma once

// The fit of a record that a vane with blades has made.

#include <stdexcept>

#include "rheometer/fits/fit.hpp"
#include "rheometer/vane/vane_blades.hpp"

namespace tremie {

struct VaneFit {
  FitResult fit;  ///< of the cylinder's torques
  double least_factor = 1.0,
         most_factor = 1.0;  ///< torque of the blades over the cylinder's, over the record
};

/// A record whose blades cannot be corrected for: no viscosity, or another law than Bingham's, of which the table is.
struct BladesRefused : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// fit() of the torques that the cylinder would have taken (torque_of_cylinder()). They hang on the viscosity: where the
/// input gives none, that of the fit before is taken until it stays. Throws std::invalid_argument as fit() and
/// blade_factor() do, and BladesRefused.
VaneFit fit_with_blades(const TorqueRecord& record, const FitInput& input, const BladeTable& table);

/// The same with notes on what the blades take, on a Bingham number beyond the table, and on alpha.
FitResult noted_fit_with_blades(const TorqueRecord& record, const FitInput& input, const BladeTable& table);

/// The plastic viscosity of a flow curve's law. Throws BladesRefused for a law that has none.
double viscosity_for_blades(const KnownLaw& law);

}  // namespace tremie
