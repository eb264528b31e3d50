#pragma once

// The sizes that concrete and its instruments have: a legal value beyond them is noted, and run as it stands.

#include <string>
#include <vector>

#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"

namespace tremie::scene {

/// What values of this key are usual, in SI; 0 and words are not judged.
struct UsualRange {
  const char* key;  ///< "vane.radius"
  double low, high;
  const char* source;
};

const std::vector<UsualRange>& usual_ranges();

/// A note for each value that the scene gives beyond its usual range, with the unit that was meant where another one
/// brings it back.
std::vector<std::string> unusual_values(const Schema& schema, const Values& values);

/// What the concrete's own weight costs it in volume, where that is more than 2 % at its foot; empty: less.
std::string softness(const Values& values);

}  // namespace tremie::scene
