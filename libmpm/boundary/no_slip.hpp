#pragma once

#include <array>

#include "libmpm/boundary/wall_law_interface.hpp"

namespace tremie {

/// The concrete sticks to the wall.
struct NoSlip {
  static constexpr FaceKind face = FaceKind::no_slip;
  static constexpr bool follows_pressure = false;
  static constexpr const char* word = "no_slip";
  static constexpr const char* use = "left out (floor.contact)";

  double bears(double) const { return unbounded; }
  static constexpr std::array<LawKey<NoSlip>, 0> keys() { return {}; }
};

}  // namespace tremie
