#pragma once

// The torque of the two ends of a vane's cylinder, as a factor on its height: what acts on the side alone is
// T = 2 pi r^2 h tau, with the ends T = 2 pi r^2 h f tau.

#include <string>
#include <vector>

#include "rheometer/reference/instrument.hpp"

namespace tremie {

/// f = 1 + 2r/(3h): the ends carry the stress of the side (Dzuy and Boger 1985).
double textbook_end_factor(const Instrument& instrument);

/// f of a table with the columns height_over_radius, container_over_radius, bingham_number and end_factor on a full grid,
/// between whose points it is linear: in radius over height, in the container, and in ln(1 + Bi), Bi = tau_0/(mu Omega).
/// Beyond its largest Bingham number the last factor holds: over the decade before it changes by 1 to 4 %.
/// Throws std::invalid_argument for a table that is none (with its line) and for an instrument outside of it (with its
/// range).
double end_factor_from_table(const std::string& csv, const std::string& name, const Instrument& instrument,
                             double bingham_number);

/// Where such a table ends.
double largest_bingham_number(const std::string& csv, const std::string& name);

}  // namespace tremie
