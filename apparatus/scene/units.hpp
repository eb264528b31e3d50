#pragma once

// Quantities as a person writes them ("54 Pa", "15 cm/s") and as the program holds them (SI).

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace tremie::scene {

enum class Dimension {
  length,
  time,
  speed,
  pressure,
  viscosity,
  density,
  rate,           ///< 1/s
  structuration,  ///< Pa/s
  rotation,       ///< rad/s
  angle,          ///< rad
  torque,
  acceleration,
  volume,
  flow,        ///< m^3/s
  wall_drag,   ///< Pa s/m: stress over the speed along a wall
  consistency  ///< Pa s^n, n the flow index of the same mix
};

/// One unit of a dimension: SI value = value * numerator / denominator. Two factors, so that "35 mm" and
/// "0.035 m" are the same double.
struct Unit {
  std::string_view name;
  double numerator = 1.0;
  double denominator = 1.0;
};

/// The units that a dimension may be written in. The first is the SI unit.
std::span<const Unit> units(Dimension dimension);

/// The dimension whose SI unit this is. Throws std::logic_error where there is none.
Dimension dimension_of(std::string_view si_unit);

/// "Pa, kPa, MPa": for messages.
std::string units_text(Dimension dimension);

/// The unit that a person who wrote no unit most likely means: mm of 590, m of 0.59, cm/s of 15. Only one whose SI value
/// is `allowed`, where any is.
std::string_view unit_meant(double number, Dimension dimension,
                            const std::function<bool(double)>& allowed = {});

/// The SI value of "54 Pa". Throws std::invalid_argument that says what is wrong and which units are allowed; where
/// the unit is missing, which is meant (as unit_meant()).
double parse_quantity(std::string_view text, Dimension dimension,
                      const std::function<bool(double)>& allowed = {});

/// "54 Pa": the SI value in the SI unit, with the fewest digits that read back to the same double.
std::string write_quantity(double value, Dimension dimension);
/// The largest that is allowed, of a positive quantity: to four digits, rounded down.
std::string write_at_most(double value, Dimension dimension);

/// The fewest digits that read back to the same double.
std::string write_number(double value);

/// "1042" and "0.0358": so many significant digits for a person, and all those before the point; an exponent only
/// from ten million on and below 0.0001.
std::string rounded(double value, int digits);

}  // namespace tremie::scene
