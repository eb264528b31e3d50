#pragma once

#include <array>

#include "libmpm/boundary/wall_law_interface.hpp"

namespace tremie {

/// A layer of paste along the wall (Kaplan's law of tribometers): the concrete slides with the speed u where the wall
/// takes tau_i + k_i u, and holds where less is asked of it. tau_i does not follow the concrete's rest.
struct Interface {
  double tau_i = 0.0;  ///< [Pa]
  double k_i = 0.0;    ///< [Pa s/m]

  static constexpr FaceKind face = FaceKind::wall_law;
  static constexpr bool follows_pressure = false;
  static constexpr const char* word = "interface";
  static constexpr const char* use = "a layer that slides, tau_i + k_i u (floor.contact)";
  static constexpr double creeping = 1e-3;  ///< slower, a body is about to stop [m/s]

  WallStress stress() const { return {tau_i, k_i}; }
  double bears(double) const { return tau_i + k_i * creeping; }
  static constexpr std::array<LawKey<Interface>, 2> keys() {
    return {{{"floor.interface_yield_stress", &Interface::tau_i, "Pa", "", "27 Pa",
              "tau_i; or interface_yield_ratio", 0.0, unbounded, false, true},
             {"floor.interface_viscosity", &Interface::k_i, "Pa.s/m", "", "1000 Pa.s/m",
              "k_i: the wall takes tau_i + k_i u", 0.0, unbounded, false}}};
  }
};

}  // namespace tremie
