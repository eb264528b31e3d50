#pragma once

// What the blades of a vane take from the torque of the cylinder that they span: between the blades the concrete is not
// carried along like a solid. A fit by the flow around a cylinder is right for a vane once its torques are those that the
// cylinder would have taken.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "rheometer/reference/instrument.hpp"

namespace tremie {

/// Torque of a section with blades over that of the cylinder, by container radius over vane radius and ln(1 + Bi),
/// Bi = tau_0/(mu Omega).
using BladeTable = std::map<double, std::map<double, double>>;

/// From CSV with the columns container_over_radius, bingham_number and blade_factor. Throws std::invalid_argument with
/// the line for a table that is none.
BladeTable blade_table(const std::string& csv, const std::string& name);

/// Linear between the table's points. Beyond its last Bingham number the factor is that of the last. Throws
/// std::invalid_argument, with the range, for a container that the table does not have.
double blade_factor(const BladeTable& table, const Instrument& instrument, double bingham_number);

/// The Bingham number up to which the table holds a container: the lesser one of its two neighbours' in the table.
double largest_bingham_number(const BladeTable& table, const Instrument& instrument);

/// The torque [N m] that a cylinder would have taken where the vane took `torque` at the speed omega [rad/s] in concrete
/// of plastic viscosity mu [Pa s]: the Bingham number is the one at which Reiner and Riwlin's torque, times the factor, is
/// the vane's. A torque below the Newtonian one is taken for Newtonian.
double torque_of_cylinder(const BladeTable& table, const Instrument& instrument, double mu, double omega,
                          double torque);

}  // namespace tremie
