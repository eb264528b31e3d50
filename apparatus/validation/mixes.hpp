#pragma once

// Mixes A to C of Wilkes, Kumar and Biscontin as they measured them (reference_data/published.toml, Table 1).

#include <array>

namespace tremie::validation {

struct PaperMix {
  const char* file;  ///< in reference_data/mixes
  const char* name;
  double fresh, rested;  ///< slump flow at once and after 240 s [mm]
  double friction;       ///< calibrated by the authors to their simulations
};

inline constexpr std::array<PaperMix, 3> paper_mix{{{"mix_a", "Mix A", 590, 575, 0.35},
                                                    {"mix_b", "Mix B", 550, 530, 0.45},
                                                    {"mix_c", "Mix C", 500, 485, 0.43}}};

/// Printed for both spreads of each mix, without saying of what [mm]; taken as the half-width of a 95 % interval.
inline constexpr double paper_tolerance = 30.0;

}  // namespace tremie::validation
