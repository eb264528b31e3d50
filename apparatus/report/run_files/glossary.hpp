#pragma once

// What the names of results and columns mean, for reports and results.h5.

#include <string>

namespace tremie::report {

/// "spread_mm": "slump flow, mean diameter". A name that is not known comes back with blanks, without its unit.
std::string words_of(const std::string& name);

/// "mm", "1/s", "N.m": the unit that a name ends with; "1" for none.
std::string unit_of(const std::string& name);

/// The same as people write it: "N·m"; empty for none. Volumes are in litres, as person_number() has them.
std::string unit_for_people(const std::string& name);

/// A number in that unit with as many digits as it has: millimetres whole, else three.
std::string person_number(double value, const std::string& name);

}  // namespace tremie::report
