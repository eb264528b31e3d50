#pragma once

// The gate of kinetics at a critical shear rate gamma_c: build-up below it, breakdown above it.

#include <algorithm>
#include <cmath>

#include "libmpm/constitutive/cubic_rate.hpp"

namespace tremie::detail {

/// A step whose shear rate is linear in time, split where it crosses gamma_c: rest(lambda, duration) is lambda after
/// build-up, flow(lambda, duration, g_0, g_1) after breakdown, with the rates at the two ends.
template <class Rest, class Flow>
double split_at_gate(double lambda, double gamma_c, double gamma_0, double gamma_1, double dt,
                     const Rest& rest, const Flow& flow) {
  const bool rest_0 = gamma_0 < gamma_c, rest_1 = gamma_1 < gamma_c;
  const auto piece = [&](double value, bool resting, double g0, double g1, double duration) {
    return resting ? rest(value, duration) : flow(value, duration, g0, g1);
  };
  if (rest_0 == rest_1) return piece(lambda, rest_0, gamma_0, gamma_1, dt);
  const double theta = std::clamp((gamma_c - gamma_0) / (gamma_1 - gamma_0), 0.0, 1.0);
  lambda = piece(lambda, rest_0, gamma_0, gamma_c, theta * dt);
  return piece(lambda, rest_1, gamma_c, gamma_1, (1.0 - theta) * dt);
}

/// Where the cubic passes gamma_c between two shares a and b of the step, at which it is on two sides of it:
/// Newton's method from the chord, held in [a, b]. To a hundredth of b - a or so: it is a first guess.
inline double crossing_of(const CubicRate& rate, double gamma_c, double a, double fa, double b, double fb) {
  double x = (a * fb - b * fa) / (fb - fa);
  for (int i = 0; i < 3; ++i) {
    const auto [value, slope] = rate.at(x);
    if (slope == 0.0) break;
    x = std::clamp(x - (value - gamma_c) / slope, a, b);
  }
  return x;
}

/// Where the rate passes gamma_c between two times a and b, at which it is fa and fb above, tried first at
/// `guess`, where its slope is about `slope`: the secant that keeps the bracket, with the weight of Anderson
/// and Bjorck (1973) for an end that stays. The error of a secant goes with the product of the two changes
/// before it; the last one is not asked for its rate.
template <class Rate>
double gate_crossing(const Rate& rate, double gamma_c, double a, double fa, double b, double fb, double guess,
                     double slope) {
  const double close = 1e-5 * (b - a) * (b - a);
  double last = guess, change = b - a;
  for (int i = 0; i < 50; ++i) {
    const double f = rate(last) - gamma_c;
    if (f == 0.0) return last;
    if ((f < 0.0) != (fb < 0.0)) {  // b is the newest of the bracket's ends
      a = b;
      fa = fb;
    } else if (i > 0) {
      const double weight = 1.0 - f / fb;
      fa *= weight > 0.0 ? weight : 0.5;
    }
    b = last;
    fb = f;
    double next = (a * fb - b * fa) / (fb - fa);
    if (const double newton = b - f / slope; i == 0 && (newton - a) * (newton - b) < 0.0) next = newton;
    if (std::abs(change * (next - last)) < close) return next;
    change = next - last;
    last = next;
  }
  return last;
}

}  // namespace tremie::detail
