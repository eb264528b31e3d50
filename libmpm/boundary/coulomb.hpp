#pragma once

#include <array>

#include "libmpm/boundary/wall_law_interface.hpp"

namespace tremie {

/// Coulomb friction: the wall holds with at most the coefficient times the force that presses on it.
struct Coulomb {
  double coefficient = 0.0;

  static constexpr FaceKind face = FaceKind::wall_law;
  static constexpr bool follows_pressure = true;
  static constexpr const char* word = "friction";
  static constexpr const char* use = "Coulomb's, at every floor node";

  double yield_force(double pressing) const { return coefficient * pressing; }
  double bears(double pressure) const { return coefficient * pressure; }
  static constexpr std::array<LawKey<Coulomb>, 1> keys() {
    return {{{"floor.coefficient", &Coulomb::coefficient, "", "0.35", "",
              "Coulomb's; the mix's friction_coefficient if it has one", 0.0, 10.0, false}}};
  }
};

}  // namespace tremie
