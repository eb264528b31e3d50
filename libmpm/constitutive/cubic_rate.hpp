#pragma once

// A shear rate that is known at every time, taken over a step by four of its values.

#include <array>
#include <cmath>
#include <utility>

namespace tremie::detail {

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

}  // namespace tremie::detail
