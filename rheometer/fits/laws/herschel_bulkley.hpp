#pragma once

// tau = tau_0 + k gamma_dot^n in the gap.

#include <algorithm>
#include <cmath>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/reference/couette_flow.hpp"

namespace tremie {

inline FlowLaw herschel_bulkley_law() {
  using Parameters = std::span<const double>;  // tau_0, k, n
  return {.name = "herschel_bulkley",
          .words = "Herschel-Bulkley",
          .line = "Herschel-Bulkley in the gap",
          .parameters = {{yield_stress_parameter()},
                         {.row = {"consistency", "Pa s^n", "consistency_Pa_s_n", "consistency", "consistency",
                                  "k"},
                          .lower = 1e-9},
                         {.row = {"flow_index", "", "flow_index", "flow index", "flow index", "n"},
                          .lower = 0.2,
                          .upper = 2.0}},
          .in_place_of_viscosity = "Herschel-Bulkley has a consistency and a flow index in its place",
          .start =
              [](const Bingham& b) {
                return std::vector{b.tau_0, std::max(b.mu, 1e-6), 1.0};
              },
          .torque =
              [](Parameters p, double omega, const Instrument& in) {
                const HerschelBulkleyTorque t = herschel_bulkley_torque({p[0], p[1], p[2]}, omega, in);
                return FlowTorque{t.torque, t.sheared_radius, {t.d_tau_0, t.d_k, t.d_n}};
              },
          .rate = [](Parameters p, double above) -> std::optional<double> {
            if (!(p[1] > 0.0)) return std::nullopt;
            return std::pow(above / p[1], 1.0 / p[2]);
          },
          .viscous =
              [](Parameters p) {
                return ViscousStress{p[1], p[2]};
              },
          .plug_below = nullptr};
}

}  // namespace tremie
