#pragma once

// Reasons of the lifted cone itself why a result is not to be trusted.

#include <string>

#include "apparatus/parts/cone/cone_test.hpp"

namespace tremie::cone {

/// A run and its scene, as the checks look at them.
struct Judged {
  const Scene& scene;
  const Outcome& run;
};

/// "2.5 % of the concrete went through the cone's wall …", or nothing: the check of the wall.
std::string went_through_the_cone(const Judged& judged);

/// Adds the reasons of all checks.
void add_reasons(const Scene& scene, Outcome& outcome);

}  // namespace tremie::cone
