#pragma once

#include <array>

#include "libmpm/boundary/wall_law_interface.hpp"

namespace tremie {

/// Nothing holds the concrete along the wall.
struct FreeSlip {
  static constexpr FaceKind face = FaceKind::free_slip;
  static constexpr bool follows_pressure = false;
  static constexpr const char* word = "free_slip";
  static constexpr const char* use = "left out (floor.contact)";

  double bears(double) const { return 0.0; }
  static constexpr std::array<LawKey<FreeSlip>, 0> keys() { return {}; }
};

}  // namespace tremie
