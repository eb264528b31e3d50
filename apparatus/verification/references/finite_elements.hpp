#pragma once

// The slump against an independent solution: body-fitted Lagrangian finite elements, exact Bingham, no slip,
// instant release of the whole cone, with inertia; spread is twice the largest radius of the free surface, to
// 2 mm (Mix C) and 3 mm (Mix A, whose spread is 558 mm at rest and 1.9 % less at 20 s).

#include <array>
#include <cmath>
#include <span>

#include "apparatus/verification/references/slump_curve.hpp"

namespace tremie::verification {

/// A spread of the finite elements [mm] at a time [s].
struct SpreadAt {
  double time, mm;
};

inline constexpr std::array<SpreadAt, 6> finite_elements_mix_c{
    {{1, 435.4}, {2, 442.4}, {3, 444.8}, {5, 446.0}, {10, 447.8}, {20, 448.8}}};
inline constexpr std::array<SpreadAt, 1> finite_elements_mix_a{{{20, 0.981 * 558.0}}};

/// The cone gone at once, without thixotropy.
inline cone::Scene instant_release(double tau_0, double mu, double duration) {
  cone::Scene scene;
  scene.mix.tau_0 = tau_0;
  scene.mix.mu = mu;
  scene.lift_speed.reset();
  scene.duration = duration;
  return scene;
}

/// Largest relative error of the spread at the reference's times.
inline double worst_error(const cone::Outcome& outcome, std::span<const SpreadAt> reference) {
  double worst = 0.0;
  for (const auto& [time, mm] : reference)
    worst = std::max(worst, std::abs(spread_at(outcome, time) / mm - 1.0));
  return worst;
}

}  // namespace tremie::verification
