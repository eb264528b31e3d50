#pragma once

// Kinetics whose breakdown goes with a power of the shear rate, after Cheng and Evans (Brit. J. Appl. Phys. 16 (1965) 1599;
// Barnes, J. Non-Newtonian Fluid Mech. 70 (1997) 1, writes a (1 - lambda)^b - c lambda gamma_dot^d):
//
//   d lambda / dt = b (1 - lambda/lambda_max) - k lambda^n gamma_dot^a,    b = A_thix/tau_0, n >= 1, 0 <= a <= 1.
//
// a = 1 is Roussel's equation, the gated one (critical_shear_rate) or the power kinetics. gamma_dot^a is 0 at rest for every
// a: concrete that is rigid builds up. With modes lambda is the sum of parts lambda_i = share_i x_i, and x_i follows the
// equation with factor_i k. Shear rates in 1/s, times in s; lambda has no unit.

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "libmpm/constitutive/power_kinetics.hpp"

namespace tremie {

namespace detail {

/// int_0^1 gamma_dot^a dx of a shear rate that goes from g_0 to g_1, with s = gamma_dot^a at both ends; not both are 0.
inline double mean_power_of_rate(double a, double g_0, double g_1, double s_0, double s_1) {
  if (std::abs(g_1 - g_0) > 0.01 * (g_0 + g_1)) return (g_1 * s_1 - g_0 * s_0) / ((1.0 + a) * (g_1 - g_0));
  return (s_0 + 4.0 * std::pow(0.5 * (g_0 + g_1), a) + s_1) / 6.0;  // to 1e-11, where the difference cancels
}

/// gamma_dot^a as a line over the step: its mean is exact for a shear rate that is linear in time.
inline std::pair<double, double> powered_rates(double a, double g_0, double g_1) {
  if (a == 1.0 || (g_0 == 0.0 && g_1 == 0.0)) return {g_0, g_1};
  const double s_0 = std::pow(g_0, a), s_1 = std::pow(g_1, a);
  const double to_mean = 2.0 * mean_power_of_rate(a, g_0, g_1, s_0, s_1) / (s_0 + s_1);
  return {to_mean * s_0, to_mean * s_1};
}

}  // namespace detail

/// One time of the breakdown: its share of lambda and of A_thix, and its factor on k.
struct BreakdownMode {
  double share = 1.0, factor = 1.0;
};

struct RatePowerKinetics {
  double breakdown = 0.0;      ///< k: k gamma_dot^a at 1 1/s [1/s]
  double rate_exponent = 0.0;  ///< a
  double gamma_c = 0.0;        ///< critical shear rate of the gate [1/s]; 0: no gate
  double exponent = 1.0;       ///< n
  double saturation = std::numeric_limits<double>::infinity();  ///< lambda_max
  std::vector<BreakdownMode> modes = {};                        ///< empty: one; at most most_modes

  static constexpr std::size_t most_modes = 6;
  static constexpr std::string_view word = "rate_power";
  static constexpr DecayFitRules decay_fit{.needs_speeds = true};
  static constexpr std::array<LawKey<RatePowerKinetics>, 5> keys() {
    using K = RatePowerKinetics;
    return {{{"mix.thixotropy.breakdown_rate", &K::breakdown, "1/s", "0.334 1/s", "",
              "k: breakdown by k lambda^n gamma_dot^a, gamma_dot in 1/s", 0.0, unbounded, false},
             {"mix.thixotropy.rate_exponent", &K::rate_exponent, "", "0.1", "",
              "a: 0, breakdown takes time; 1, it takes strain", 0.0, 1.0, false},
             {.name = "mix.thixotropy.critical_shear_rate",
              .member = &K::gamma_c,
              .unit = "1/s",
              .help = "no gate where it is left out",
              .low_open = false,
              .optional = true},
             {.name = "mix.thixotropy.exponent",
              .member = &K::exponent,
              .help = "1 where it is left out",
              .low = 1.0,
              .high = 20.0,
              .low_open = false,
              .optional = true},
             {.name = "mix.thixotropy.saturation",
              .member = &K::saturation,
              .help = "lambda_max; none where it is left out",
              .optional = true}}};
  }
  static RatePowerKinetics fitted(double k, double exponent, double) {
    RatePowerKinetics found;
    found.breakdown = k, found.exponent = exponent;
    return found;
  }

  std::optional<double> gate() const { return gamma_c > 0.0 ? std::optional(gamma_c) : std::nullopt; }
  bool breaks_down() const { return breakdown != 0.0; }
  double after_rest(double lambda, double A_thix, double tau_0, double duration) const {
    return detail::power_build(lambda, rates(A_thix / tau_0), duration);
  }

  /// The kinetics of x_i.
  RatePowerKinetics of_mode(std::size_t i) const {
    return {breakdown * modes[i].factor, rate_exponent, gamma_c, exponent, saturation};
  }

  /// Of lambda without modes. n = 1: exact at constant rate; else detail::power_step. With a gate exact where n = 1 and
  /// where the rate is linear in time.
  double update(double lambda, double build_rate, double gamma_0, double gamma_1, double dt) const {
    const detail::PowerRates p = rates(build_rate);
    if (!gate()) {
      const auto [s_0, s_1] = detail::powered_rates(rate_exponent, gamma_0, gamma_1);
      return detail::power_step(lambda, p, s_0, s_1, dt);
    }
    return detail::split_at_gate(
        lambda, gamma_c, gamma_0, gamma_1, dt,
        [&](double value, double duration) { return detail::power_build(value, p, duration); },
        [&](double value, double duration, double g_0, double g_1) {
          const auto [s_0, s_1] = detail::powered_rates(rate_exponent, g_0, g_1);
          return detail::gated_break(value, p, duration, s_0 + s_1);
        });
  }

 private:
  detail::PowerRates rates(double build_rate) const {
    return {build_rate, 1.0 / saturation, breakdown, exponent};
  }
};

}  // namespace tremie
