#pragma once

// Kinetics whose breakdown goes with a power of lambda, for decays that are fast at first and slow later:
//
//   d lambda / dt = b (1 - lambda/lambda_max) - alpha lambda^n gamma_dot,    b = A_thix/tau_0, n >= 1.
//
// n = 1 without lambda_max is Roussel's equation. Shear rates in 1/s, times in s; lambda has no unit.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "libmpm/constitutive/exponential_decay.hpp"
#include "libmpm/constitutive/gate.hpp"
#include "libmpm/constitutive/kinetics_interface.hpp"

namespace tremie {

namespace detail {

/// The constants of the equation over one step.
struct PowerRates {
  double build = 0.0;               ///< b [1/s]
  double inverse_saturation = 0.0;  ///< 1/lambda_max; 0: none
  double alpha = 0.0, exponent = 1.0;
};

/// At rest: lambda_max - (lambda_max - lambda) exp(-b t/lambda_max), in a form that holds for 1/lambda_max = 0.
inline double power_build(double lambda, const PowerRates& p, double duration) {
  const double z = p.build * p.inverse_saturation * duration;
  const double mean = z > 1e-12 ? -std::expm1(-z) / z : 1.0;
  return lambda + p.build * duration * mean * (1.0 - lambda * p.inverse_saturation);
}

/// Without build-up: lambda (1 + (n-1) k)^(-1/(n-1)) with k = alpha lambda^(n-1) shear, shear = int gamma_dot dt.
inline double power_break(double lambda, const PowerRates& p, double shear) {
  if (!(lambda > 0.0)) return 0.0;
  const double m = p.exponent - 1.0, k = p.alpha * shear * std::pow(lambda, m);
  return m < 1e-9 ? lambda * std::exp(-k) : lambda * std::exp(-std::log1p(m * k) / m);
}

/// Above a gate, where nothing is built: `sum` of gamma_dot at both ends of a part of the step.
inline double gated_break(double lambda, const PowerRates& p, double duration, double sum) {
  if (p.exponent == 1.0) return lambda * decay(0.5 * p.alpha * duration * sum).end;
  return power_break(lambda, p, 0.5 * duration * sum);
}

/// n = 1: exact at constant rate, fourth order at a linear rate, second order where the rate is curved.
inline double linear_step(double lambda, const PowerRates& p, double gamma_0, double gamma_1, double dt) {
  const double half = 0.5 * p.alpha * dt;
  const Decay d = decay(half * (gamma_0 + gamma_1) + p.build * p.inverse_saturation * dt);
  return build_and_break(lambda, p.build, d, half * (gamma_1 - gamma_0) * d.asymmetry, dt);
}

/// phi_k(z) = int_0^1 e^(z(1-s)) s^(k-1)/(k-1)! ds, which exponential methods weight their stages with.
struct PhiFunctions {
  double phi_1, phi_3, phi_4;
};

inline PhiFunctions phi_functions(double z) {
  if (std::abs(z) > 1.0) {
    const double phi_1 = std::expm1(z) / z, phi_3 = ((phi_1 - 1.0) / z - 0.5) / z;
    return {phi_1, phi_3, (phi_3 - 1.0 / 6.0) / z};
  }
  double phi_4 = 1.0;  // 24 phi_4 = 1 + z/5 (1 + z/6 (1 + ...))
  for (int k = 18; k >= 5; --k) phi_4 = 1.0 + phi_4 * z / k;
  phi_4 /= 24.0;
  const double phi_3 = 1.0 / 6.0 + z * phi_4;
  return {1.0 + z * (0.5 + z * phi_3), phi_3, phi_4};
}

/// du/dt = linear u - bend u^power + constant, concave in u >= 0: the equation in u = lambda (build-up from below), or
/// in u = lambda^(1-n) (breakdown from above, where it is linear but for the build-up).
struct ConcaveRate {
  double constant, linear, bend, power;
};

/// One step of h of exprb43 (Hochbruck, Ostermann and Schweitzer 2009): order four, and its difference from order
/// three. A value that leaves u >= 0 is cut there.
inline std::pair<double, double> exponential_rosenbrock(const ConcaveRate& f, double u, double h) {
  const double bent = f.bend * std::pow(u, f.power),
               d_bent = u > 0.0 ? f.power * bent / u : (f.power > 1.0 ? 0.0 : f.bend);
  const double slope = f.linear - d_bent, rate = f.constant + f.linear * u - bent;
  const auto left_out = [&](double v) { return bent + d_bent * (v - u) - f.bend * std::pow(v, f.power); };
  const PhiFunctions half = phi_functions(0.5 * slope * h), whole = phi_functions(slope * h);
  const double middle = left_out(std::max(0.0, u + 0.5 * h * half.phi_1 * rate));
  const double end = left_out(std::max(0.0, u + h * whole.phi_1 * (rate + middle)));
  const double third = h * whole.phi_3 * (16.0 * middle - 2.0 * end),
               fourth = h * whole.phi_4 * (12.0 * end - 48.0 * middle);
  return {std::max(0.0, u + h * whole.phi_1 * rate + third + fourth), std::abs(fourth)};
}

/// Build-up and breakdown over dt, the shear rate linear in time: second order in dt, at constant rate within 1e-8
/// whatever dt, in parts whose lengths follow the error: 1 where alpha lambda^(n-1) gamma_dot dt is small, tens at 1e6.
/// Positive, and at most lambda + b dt.
inline double power_step(double lambda, const PowerRates& p, double gamma_0, double gamma_1, double dt) {
  if (p.exponent == 1.0) return linear_step(lambda, p, gamma_0, gamma_1, dt);
  constexpr double tolerance = 1e-8;
  constexpr int most = 1000;
  const double m = p.exponent - 1.0, c = p.build * p.inverse_saturation;
  double done = 0.0, h = dt;
  for (int i = 0; i < most && done < dt * (1.0 - 1e-14); ++i) {
    const bool last = i + 1 == most;
    h = last ? dt - done : std::min(h, dt - done);
    const double breaking = p.alpha * std::max(0.0, gamma_0 + (done + 0.5 * h) / dt * (gamma_1 - gamma_0));
    const bool falls = m > 0.05 && breaking * std::pow(lambda, p.exponent) > p.build - c * lambda;
    const ConcaveRate f = falls ? ConcaveRate{m * breaking, m * c, m * p.build, p.exponent / m}
                                : ConcaveRate{p.build, -c, breaking, p.exponent};
    const double u = falls ? std::pow(lambda, -m) : lambda;
    auto [next, error] = exponential_rosenbrock(f, u, h);
    if (falls) {
      error /= m * std::max(u, next);
      next = std::pow(std::max(next, u), -1.0 / m);
    } else {
      error /= std::max(next, 0.1);
    }
    next = std::min(next, lambda + p.build * h);
    const bool sound = std::isfinite(next) && std::isfinite(error);
    const double change = sound ? 0.9 * std::pow(tolerance / std::max(error, 1e-30), 0.25) : 0.0;
    if (!last && (!sound || error > tolerance)) {
      h *= std::clamp(change, 0.05, 0.7);
      continue;
    }
    if (sound) lambda = next;
    done += h;
    h *= std::clamp(change, 0.3, 10.0);
  }
  return lambda;
}

}  // namespace detail

struct PowerKinetics {
  double alpha = 0.01;    ///< destructuration parameter
  double gamma_c = 0.0;   ///< critical shear rate of the gate [1/s]; 0: no gate
  double exponent = 1.0;  ///< n
  double saturation = std::numeric_limits<double>::infinity();  ///< lambda_max

  static constexpr std::string_view word = "power";
  static constexpr DecayFitRules decay_fit{.free_exponent = true, .contains = "roussel"};
  static constexpr std::array<LawKey<PowerKinetics>, 4> keys() {
    using K = PowerKinetics;
    return {{destructuration_key<K>(),
             {.name = "mix.thixotropy.critical_shear_rate",
              .member = &K::gamma_c,
              .unit = "1/s",
              .help = "no gate where it is left out",
              .optional = true},
             {"mix.thixotropy.exponent", &K::exponent, "", "", "3.5",
              "n: breakdown by alpha lambda^n gamma_dot", 1.0, 20.0, false},
             {.name = "mix.thixotropy.saturation",
              .member = &K::saturation,
              .help = "lambda_max; none where it is left out",
              .optional = true}}};
  }
  /// Without a gate and without a saturation.
  static PowerKinetics fitted(double alpha, double exponent, double) { return {alpha, 0.0, exponent}; }

  std::optional<double> gate() const { return gamma_c > 0.0 ? std::optional(gamma_c) : std::nullopt; }
  bool breaks_down() const { return alpha != 0.0; }
  double after_rest(double lambda, double A_thix, double tau_0, double duration) const {
    return detail::power_build(lambda, rates(A_thix / tau_0), duration);
  }

  /// Exact where the rate is linear in time, with a gate; else detail::power_step.
  double update(double lambda, double build_rate, double gamma_0, double gamma_1, double dt) const {
    const detail::PowerRates p = rates(build_rate);
    if (!gate()) return detail::power_step(lambda, p, gamma_0, gamma_1, dt);
    return detail::split_at_gate(
        lambda, gamma_c, gamma_0, gamma_1, dt,
        [&](double value, double duration) { return detail::power_build(value, p, duration); },
        [&](double value, double duration, double g_0, double g_1) {
          return detail::gated_break(value, p, duration, g_0 + g_1);
        });
  }

 private:
  detail::PowerRates rates(double build_rate) const {
    return {build_rate, 1.0 / saturation, alpha, exponent};
  }
};

}  // namespace tremie
