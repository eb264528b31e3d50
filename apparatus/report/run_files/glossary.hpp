#pragma once

// What the names of results and columns mean, for reports and results.h5.

#include <string>

#include "apparatus/common/readings.hpp"

namespace tremie::report {

/// "spread_mm": "slump flow, mean diameter", as the apparatus has it where it is given. A name that is not known comes back with blanks, without its unit.
std::string words_of(const std::string& name, const std::string& apparatus = {});

using scene::unit_for_people;
using scene::unit_of;

/// A number in that unit with as many digits as it has: millimetres whole, else three.
std::string person_number(double value, const std::string& name);

/// "spread (mm)", or the words alone where there is no unit.
std::string with_unit(const std::string& words, const std::string& unit);

}  // namespace tremie::report
