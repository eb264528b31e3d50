#pragma once

// The flocculation state lambda along a history whose shear rate is known at every time: the per-point update
// of flocculation.hpp, which knows the ends of a step alone, with two rates from inside the step as well.
// Sixth order.

#include <array>
#include <utility>

#include "libmpm/constitutive/flocculation.hpp"

namespace tremie {

namespace detail {

/// The share of a step at which Lobatto's rule of four points has its inner ones: (1 -+ 1/sqrt(5))/2.
inline constexpr std::array<double, 4> lobatto{0.0, 0.27639320225002103, 0.72360679774997897, 1.0};

/// A shear rate that is cubic over a step, mean + a1 P1 + a2 P2 + a3 P3 (Legendre), by its values at lobatto.
struct CubicRate {
  std::array<double, 4> value;
  double mean, a1, a2, a3;

  explicit CubicRate(const std::array<double, 4>& g) : value(g) {
    const double inner = std::sqrt(5.0) * (g[2] - g[1]), outer = g[3] - g[0];
    mean = (g[0] + g[3] + 5.0 * (g[1] + g[2])) / 12.0;
    a1 = 0.25 * (outer + inner);
    a2 = 5.0 / 12.0 * (g[0] + g[3] - g[1] - g[2]);
    a3 = 0.25 * (outer - inner);
  }

  /// Value, and slope over the share x of the step.
  std::pair<double, double> at(double x) const {
    const double u = 2.0 * x - 1.0;
    return {mean + a1 * u + a2 * (1.5 * u * u - 0.5) + a3 * u * (2.5 * u * u - 1.5),
            2.0 * (a1 + 3.0 * a2 * u + a3 * (7.5 * u * u - 1.5))};
  }
};

template <class Rate>
CubicRate cubic_rate(const Rate& rate, double start, double gamma_0, double gamma_1, double dt) {
  return CubicRate({gamma_0, rate(start + lobatto[1] * dt), rate(start + lobatto[2] * dt), gamma_1});
}

/// Equation (3) over dt. alpha dt int_x^1 gamma_dot dx = ku + c u(1 - u) + d u(1 - u)(1 - 2u) + ..., u = 1 -
/// x; the variance of u(1 - u), 1/180 at k = 0 and 1/k^2 far from it, is the second term of the mean of the
/// exponential.
inline double roussel_step(double lambda, double build_rate, double alpha, const CubicRate& rate, double dt) {
  const double k = alpha * dt * rate.mean, c = alpha * dt * rate.a1;
  const Decay d = decay(k);
  const double z = c * d.asymmetry + alpha * dt * rate.a2 * d.curvature - 0.5 * c * c / (180.0 + k * k);
  return build_and_break(lambda, build_rate, d, z, dt);
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

/// The gated kinetics: build-up where the rate is below gamma_c, breakdown where it is above. `halvings`: how
/// often a step that comes close to the gate is halved to see whether it passes it twice.
template <class Rate>
double gated_step(double lambda, double build_rate, const Thixotropy& t, const Rate& rate, double start,
                  double gamma_0, double gamma_1, double dt, int halvings = 6) {
  const CubicRate g = cubic_rate(rate, start, gamma_0, gamma_1, dt);
  const auto [low, high] = std::minmax_element(g.value.begin(), g.value.end());
  const double between = std::abs(g.a2) + std::abs(g.a3);  // the rate may leave its values by this
  if (*low - between >= t.gamma_c) return lambda * decay(t.alpha * dt * g.mean).end;
  if (*high + between < t.gamma_c) return lambda + build_rate * dt;
  const bool same_side = (*low < t.gamma_c) == (*high < t.gamma_c);
  if (same_side && halvings > 0) {
    const double middle = rate(start + 0.5 * dt);
    lambda = gated_step(lambda, build_rate, t, rate, start, gamma_0, middle, 0.5 * dt, halvings - 1);
    return gated_step(lambda, build_rate, t, rate, start + 0.5 * dt, middle, gamma_1, 0.5 * dt, halvings - 1);
  }
  double from = start, gamma_from = gamma_0;
  const auto go_to = [&](double to, double gamma_to, bool resting) {
    const double length = to - from;
    lambda =
        resting ? lambda + build_rate * length
                : lambda *
                      decay(t.alpha * length * cubic_rate(rate, from, gamma_from, gamma_to, length).mean).end;
    from = to;
    gamma_from = gamma_to;
  };
  for (std::size_t i = 1; i < 4; ++i) {
    const double a = g.value[i - 1] - t.gamma_c, b = g.value[i] - t.gamma_c;
    if ((a < 0.0) == (b < 0.0)) continue;
    const double guess = crossing_of(g, t.gamma_c, lobatto[i - 1], a, lobatto[i], b);
    go_to(gate_crossing(rate, t.gamma_c, start + lobatto[i - 1] * dt, a, start + lobatto[i] * dt, b,
                        start + guess * dt, g.at(guess).second / dt),
          t.gamma_c, a < 0.0);
  }
  go_to(start + dt, gamma_1, gamma_1 < t.gamma_c);
  return lambda;
}

}  // namespace detail

/// lambda after a step of length dt from the time `start` of a history, in which rate(time) [1/s] gives the
/// shear rate. gamma_0 and gamma_1 are its values at the ends of the step, which the neighbouring steps
/// share. Sixth order where the rate is smooth, through the gate of the gated kinetics too; exact at constant
/// rate; positive and bounded for every dt. The power kinetics takes the rate at the ends alone: second order.
template <class Rate>
double flocculation_step_along(double lambda, const Thixotropy& t, double tau_0, const Rate& rate,
                               double start, double gamma_0, double gamma_1, double dt) {
  const double build_rate = t.A_thix / tau_0;
  if (t.kinetics == Kinetics::gated)
    return detail::gated_step(lambda, build_rate, t, rate, start, gamma_0, gamma_1, dt);
  if (t.kinetics == Kinetics::power) return flocculation_step(lambda, t, tau_0, gamma_0, gamma_1, dt);
  return detail::roussel_step(lambda, build_rate, t.alpha,
                              detail::cubic_rate(rate, start, gamma_0, gamma_1, dt), dt);
}

}  // namespace tremie
