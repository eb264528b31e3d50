#pragma once

// Reasons of the lifted cone itself why a result is not to be trusted.

#include "apparatus/parts/cone/readings.hpp"

namespace tremie::cone {

/// "2.5 % of the concrete went through the cone's wall …", or nothing: the check of the wall.
std::string went_through_the_cone(const View& run);

/// Adds the reasons of all checks.
void add_reasons(const Scene& scene, Outcome& outcome);

}  // namespace tremie::cone
