#pragma once

// Bingham in the gap, by Reiner-Riwlin.

#include <cmath>

#include "rheometer/fits/flow_law.hpp"

namespace tremie {

inline FlowLaw bingham_law() {
  using Parameters = std::span<const double>;  // tau_0, mu
  return {.name = "bingham",
          .words = "Bingham",
          .line = "Reiner-Riwlin",
          .parameters = {{yield_stress_parameter()}, {plastic_viscosity_parameter()}},
          .in_place_of_viscosity = "",
          .start =
              [](const Bingham& b) {
                return std::vector{b.tau_0, b.mu};
              },
          .torque =
              [](Parameters p, double omega, const Instrument& in) {
                const CouetteState s = reiner_riwlin({p[0], p[1]}, omega, in);
                return FlowTorque{s.torque, s.sheared_radius, {s.d_torque_d_tau_0, s.d_torque_d_mu}};
              },
          .rate = [](Parameters p, double above) -> std::optional<double> {
            if (!(p[1] > 0.0)) return std::nullopt;
            return above / p[1];
          },
          .viscous =
              [](Parameters p) {
                return ViscousStress{p[1], 1.0};
              },
          .plug_below = [](Parameters p, const Instrument& in) -> std::optional<double> {
            if (!(p[0] > 0.0 && p[1] > 0.0)) return std::nullopt;
            const double ratio = in.container_radius / in.vane_radius;
            return p[0] / (2.0 * p[1]) * (ratio * ratio - 1.0 - 2.0 * std::log(ratio));
          }};
}

}  // namespace tremie
