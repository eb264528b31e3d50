#pragma once

// Thin-layer theory of a round patch of Bingham fluid on a floor, and closed forms of it. SI units.
//
// With h(r, t) the depth and S = |dh/dr|, the shear stress rho g S (h - z) exceeds tau_0 below Y = h -
// tau_0/(rho g S):
//   dh/dt + (1/r) d(r Q)/dr = 0,     Q = rho g S Y^2 (3h - Y) / (6 mu)  downhill, zero where Y <= 0.
// Explicit finite volumes; |dQ/dS| <= rho g h^3/(3 mu) for every yield stress, which bounds the step.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace tremie::verification {

struct Fluid {
  double rho, g, tau_0, mu;
};

/// The patch: depths of rings dr wide, from the axis outwards.
struct Layer {
  double dr = 1e-3;
  std::vector<double> h;

  double radius(std::size_t face) const { return static_cast<double>(face) * dr; }
  double area(std::size_t i) const {
    return std::numbers::pi * (std::pow(radius(i + 1), 2) - std::pow(radius(i), 2));
  }
  double volume() const {
    double V = 0.0;
    for (std::size_t i = 0; i < h.size(); ++i) V += h[i] * area(i);
    return V;
  }
  /// Where the depth falls below a fifth of a ring's width: the front is steep, so it lies in that ring.
  double front() const {
    for (std::size_t i = h.size(); i-- > 0;)
      if (h[i] > 0.2 * dr) return radius(i + 1);
    return 0.0;
  }
};

/// Flux per unit of width across a face between the depths a (inner) and b (outer).
inline double flux(const Fluid& f, double a, double b, double dr) {
  const double slope = (a - b) / dr, S = std::abs(slope), h = 0.5 * (a + b);
  const double weight = f.rho * f.g * S;
  const double Y = weight > 0.0 ? h - f.tau_0 / weight : 0.0;
  if (Y <= 0.0) return 0.0;
  return weight * Y * Y * (3.0 * h - Y) / (6.0 * f.mu) * (slope > 0.0 ? 1.0 : -1.0);
}

/// Advances the layer from time 0 to `duration`.
inline void spread_layer(const Fluid& fluid, double duration, Layer& layer) {
  std::vector<double>& h = layer.h;
  std::vector<double> Q(h.size() + 1, 0.0);
  for (double t = 0.0; t < duration;) {
    const double deepest = *std::max_element(h.begin(), h.end());
    const double diffusivity = fluid.rho * fluid.g * std::pow(deepest, 3) / (3.0 * fluid.mu);
    const double dt = std::min(duration - t, 0.4 * layer.dr * layer.dr / diffusivity);
    for (std::size_t i = 1; i < h.size(); ++i) Q[i] = flux(fluid, h[i - 1], h[i], layer.dr);
    for (std::size_t i = 0; i < h.size(); ++i) {
      const double out = layer.radius(i + 1) * Q[i + 1] - layer.radius(i) * Q[i];
      h[i] -= dt * 2.0 * std::numbers::pi * out / layer.area(i);
    }
    t += dt;
  }
}

/// Huppert (1982): a volume V of Newtonian fluid spreads as R = (1024/(81 pi^3))^(1/8) (g V^3/(3 nu))^(1/8)
/// t^(1/8).
inline const double huppert_prefactor =
    std::pow(1024.0 / (81.0 * std::pow(std::numbers::pi, 3)), 0.125);  // 0.894
inline double huppert_radius(double V, double nu, double g, double t) {
  return huppert_prefactor * std::pow(g * V * V * V / (3.0 * nu) * t, 0.125);
}
/// Its depth, 4V/(3 pi R^2) (1 - r^2/R^2)^(1/3).
inline double huppert_depth(double V, double R, double r) {
  return r < R ? 4.0 * V / (3.0 * std::numbers::pi * R * R) * std::cbrt(1.0 - r * r / (R * R)) : 0.0;
}

/// Radius at rest of a volume V whose depth obeys h^2/2 - a l h = l (R - r), l = tau_0/(rho g): a = sqrt(3)
/// pi/4 takes the normal stress of the extending plug into account, a = 0 is the thin-layer law.
inline double rest_radius(const Fluid& fluid, double V, double a) {
  const double l = fluid.tau_0 / (fluid.rho * fluid.g);
  const auto volume = [&](double R) {
    constexpr int n = 20000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
      const double r = (i + 0.5) / n * R;
      sum += (a * l + std::sqrt(a * a * l * l + 2.0 * l * (R - r))) * 2.0 * std::numbers::pi * r * R / n;
    }
    return sum;
  };
  double low = 0.0, high = 2.0;
  for (int i = 0; i < 50; ++i) (volume(0.5 * (low + high)) < V ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}
inline const double plug_normal_stress = std::sqrt(3.0) * std::numbers::pi / 4.0;

}  // namespace tremie::verification
