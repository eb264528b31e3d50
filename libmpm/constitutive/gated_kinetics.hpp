#pragma once

// The paper's algorithm: equation (3) at rest, A_thix/tau_0, below the critical shear rate gamma_c, and equation (4),
// -alpha lambda gamma_dot, above it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "libmpm/constitutive/exponential_decay.hpp"
#include "libmpm/constitutive/gate.hpp"
#include "libmpm/constitutive/kinetics_interface.hpp"

namespace tremie {

struct GatedKinetics {
  double alpha = 0.01;   ///< destructuration parameter
  double gamma_c = 0.1;  ///< critical shear rate of the gate [1/s]

  static constexpr std::string_view word = "gated";
  static constexpr DecayFitRules decay_fit{};
  static constexpr std::array<LawKey<GatedKinetics>, 2> keys() {
    return {{destructuration_key<GatedKinetics>(),
             {"mix.thixotropy.critical_shear_rate", &GatedKinetics::gamma_c, "1/s", "0.1 1/s", "",
              "build-up below it, breakdown above"}}};
  }
  static GatedKinetics fitted(double alpha, double, double gamma_c) { return {alpha, gamma_c}; }

  std::optional<double> gate() const { return gamma_c; }
  bool breaks_down() const { return alpha != 0.0; }
  double after_rest(double lambda, double A_thix, double tau_0, double duration) const {
    return lambda + A_thix * duration / tau_0;
  }

  /// Exact where the rate is linear in time.
  double update(double lambda, double build_rate, double gamma_0, double gamma_1, double dt) const {
    return detail::split_at_gate(
        lambda, gamma_c, gamma_0, gamma_1, dt,
        [&](double value, double duration) { return value + build_rate * duration; },
        [&](double value, double duration, double g_0, double g_1) {
          return value * detail::decay(0.5 * alpha * duration * (g_0 + g_1)).end;
        });
  }

  f64x8 simd_update(const f64x8& lambda, double build_rate, const f64x8& gamma_0, const f64x8& gamma_1,
                    double dt) const {
    const double built = build_rate * dt, half = 0.5 * alpha * dt;
    const f64x8 none = {}, gate = none + gamma_c;
    const i64x8 rest_0 = gamma_0 < gamma_c, rest_1 = gamma_1 < gamma_c;
    const i64x8 crosses = rest_0 ^ rest_1;
    if (!any(crosses)) return select(rest_0, lambda + built, lambda * decay(half * (gamma_0 + gamma_1)));
    // Before and after the crossing of gamma_c at the share theta of the step.
    const f64x8 ones = none + 1.0;
    const f64x8 theta = select(crosses, (gate - gamma_0) / select(crosses, gamma_1 - gamma_0, ones), ones);
    const f64x8 before = select(rest_0, built * theta, none);
    const f64x8 after = select(crosses & rest_1, built * (1.0 - theta), none);
    const f64x8 flow_0 = select(rest_0, none, half * theta * (gamma_0 + select(crosses, gate, gamma_1)));
    const f64x8 flow_1 = select(crosses & rest_0, half * (1.0 - theta) * (gate + gamma_1), none);
    return (lambda + before) * decay(flow_0 + flow_1) + after;
  }

  /// Sixth order, through the gate too. `halvings`: how often a step that comes close to the gate is halved to see
  /// whether it passes it twice.
  template <class Rate>
  double update_along(double lambda, double build_rate, const Rate& rate, double start, double gamma_0,
                      double gamma_1, double dt, int halvings = 6) const {
    const detail::CubicRate g = detail::cubic_rate(rate, start, gamma_0, gamma_1, dt);
    const auto [low, high] = std::minmax_element(g.value.begin(), g.value.end());
    const double between = std::abs(g.a2) + std::abs(g.a3);  // the rate may leave its values by this
    if (*low - between >= gamma_c) return lambda * detail::decay(alpha * dt * g.mean).end;
    if (*high + between < gamma_c) return lambda + build_rate * dt;
    const bool same_side = (*low < gamma_c) == (*high < gamma_c);
    if (same_side && halvings > 0) {
      const double half = 0.5 * dt, middle = rate(start + half);
      lambda = update_along(lambda, build_rate, rate, start, gamma_0, middle, half, halvings - 1);
      return update_along(lambda, build_rate, rate, start + half, middle, gamma_1, half, halvings - 1);
    }
    double from = start, gamma_from = gamma_0;
    const auto go_to = [&](double to, double gamma_to, bool resting) {
      const double length = to - from;
      const auto mean = [&] { return detail::cubic_rate(rate, from, gamma_from, gamma_to, length).mean; };
      lambda = resting ? lambda + build_rate * length : lambda * detail::decay(alpha * length * mean()).end;
      from = to;
      gamma_from = gamma_to;
    };
    for (std::size_t i = 1; i < 4; ++i) {
      const double a = g.value[i - 1] - gamma_c, b = g.value[i] - gamma_c;
      if ((a < 0.0) == (b < 0.0)) continue;
      const double left = detail::lobatto[i - 1], right = detail::lobatto[i];
      const double guess = detail::crossing_of(g, gamma_c, left, a, right, b);
      go_to(detail::gate_crossing(rate, gamma_c, start + left * dt, a, start + right * dt, b,
                                  start + guess * dt, g.at(guess).second / dt),
            gamma_c, a < 0.0);
    }
    go_to(start + dt, gamma_1, gamma_1 < gamma_c);
    return lambda;
  }
};

}  // namespace tremie
