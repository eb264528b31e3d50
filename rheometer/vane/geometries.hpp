#pragma once

// Geometries of rheometers by their sizes or by their name in reference_data/geometries: cylinders, which shear unevenly,
// and those whose shear rate and stress are the speed and the torque times a constant.

#include <optional>
#include <string>

#include "rheometer/reference/instrument.hpp"

namespace tremie {

struct Geometry {
  std::string words;  ///< "cone and plate, radius 25 mm, angle 1 deg"
  std::optional<Instrument> cylinders;
  double stress_constant = 0.0;  ///< without cylinders: shear stress by torque [Pa/(N m)]
  double strain_constant = 0.0;  ///< shear rate by speed [1/s by rad/s]
  /// The stress constant holds for an even stress, which parallel plates do not have: a part of the stress that goes as
  /// the rate to the power n is 3/(n + 3) of the rim's in it.
  bool plates = false;
  std::optional<double> torque_per_degree;  ///< of an instrument with a dial [N m]
};

/// "cylinders, R_i, R_o, height", "cone_plate, radius, angle", "parallel_plates, radius, gap", "double_gap, R_1, R_2, R_3,
/// R_4, height" with R_1 < R_2 the inner gap and R_3 < R_4 the outer one, "constants, stress constant, strain constant",
/// or a name of the table. Lengths with mm, cm or m, the angle with deg or rad, constants in SI. Throws
/// std::invalid_argument with what is allowed.
Geometry geometry_of(const std::string& text, const std::string& table, const std::string& table_name);

}  // namespace tremie
