#pragma once

// Kinetics whose breakdown goes with a power of lambda, for decays that are fast at first and slow later:
//
//   d lambda / dt = b (1 - lambda/lambda_max) - alpha lambda^n gamma_dot,    b = A_thix/tau_0, n >= 1.
//
// n = 1 without lambda_max is Roussel's equation. Shear rates in 1/s, times in s; lambda has no unit.

#include <algorithm>
#include <cmath>
#include <utility>

namespace tremie::detail {

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

/// phi_k(z) = int_0^1 e^(z(1-s)) s^(k-1)/(k-1)! ds, which exponential methods weight their stages with.
struct PhiFunctions {
  double one, three, four;
};

inline PhiFunctions phi_functions(double z) {
  if (std::abs(z) > 1.0) {
    const double one = std::expm1(z) / z, three = ((one - 1.0) / z - 0.5) / z;
    return {one, three, (three - 1.0 / 6.0) / z};
  }
  double four = 1.0;  // 24 phi_4 = 1 + z/5 (1 + z/6 (1 + ...))
  for (int k = 18; k >= 5; --k) four = 1.0 + four * z / k;
  four /= 24.0;
  const double three = 1.0 / 6.0 + z * four;
  return {1.0 + z * (0.5 + z * three), three, four};
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
  const double middle = left_out(std::max(0.0, u + 0.5 * h * half.one * rate));
  const double end = left_out(std::max(0.0, u + h * whole.one * (rate + middle)));
  const double third = h * whole.three * (16.0 * middle - 2.0 * end),
               fourth = h * whole.four * (12.0 * end - 48.0 * middle);
  return {std::max(0.0, u + h * whole.one * rate + third + fourth), std::abs(fourth)};
}

/// Build-up and breakdown over dt, the shear rate linear in time: second order in dt, at constant rate within 1e-8
/// whatever dt, in parts whose lengths follow the error: 1 where alpha lambda^(n-1) gamma_dot dt is small, tens at 1e6.
/// Positive, and at most lambda + b dt.
inline double power_step(double lambda, const PowerRates& p, double gamma_0, double gamma_1, double dt) {
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

/// Build-up below the critical shear rate, breakdown above it; exact where the rate is linear in time.
inline double gated_power_step(double lambda, const PowerRates& p, double gamma_c, double gamma_0,
                               double gamma_1, double dt) {
  const bool rest_0 = gamma_0 < gamma_c, rest_1 = gamma_1 < gamma_c;
  const auto piece = [&](double value, bool rest, double g0, double g1, double duration) {
    return rest ? power_build(value, p, duration) : power_break(value, p, 0.5 * duration * (g0 + g1));
  };
  if (rest_0 == rest_1) return piece(lambda, rest_0, gamma_0, gamma_1, dt);
  const double theta = std::clamp((gamma_c - gamma_0) / (gamma_1 - gamma_0), 0.0, 1.0);
  lambda = piece(lambda, rest_0, gamma_0, gamma_c, theta * dt);
  return piece(lambda, rest_1, gamma_c, gamma_1, (1.0 - theta) * dt);
}

}  // namespace tremie::detail
