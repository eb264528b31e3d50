#pragma once

// What a vane test says to a person: what the instrument would report, beside what went in.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::scene {

/// The concrete as the vane meets it.
struct VaneInput {
  double yield_stress = 0.0;                            ///< [Pa]
  double plastic_viscosity = 0.0;                       ///< [Pa s]; not a number for a law that has none
  double static_yield_stress = 0.0;                     ///< (1 + lambda) tau_0 after the rest [Pa]
  std::optional<double> flocculation = {}, alpha = {};  ///< lambda after the rest
};
VaneInput vane_input(const icar_vane::Scene& scene);

std::vector<std::string> vane_lines(const icar_vane::Scene& scene, const icar_vane::Outcome& outcome);

}  // namespace tremie::scene
