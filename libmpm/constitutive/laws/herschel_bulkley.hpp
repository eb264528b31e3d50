#pragma once

// Herschel and Bulkley (1926): tau = tau_y + k gamma_dot^n beyond the yield stress, exact and regularised. The
// viscous part is the law's own, and the mix has no plastic viscosity beside it; but at n = 1 it is Newtonian, and
// the mix has all of it (mu = k): these laws are then ExactBingham and Papanastasiou to the last digit.

#include <algorithm>
#include <array>
#include <cmath>

#include "libmpm/constitutive/laws/law_interface.hpp"
#include "libmpm/constitutive/laws/papanastasiou.hpp"

namespace tremie {

namespace detail {

/// The d > 0 with k d^n + r d = b, for b > 0: Newton's method in ln d, where the left side is convex and grows like a
/// power between n and 1, so that a few steps do from any start.
inline double power_law_root(double k, double n, double r, double b) {
  double x = std::min(std::log(b / k) / n, std::log(b / r));  // the root lies within a factor of two below
  for (int i = 0; i < 50; ++i) {
    const double power = k * std::exp(n * x), line = r * std::exp(x), sum = power + line;
    const double step = std::log(b / sum) * sum / (n * power + line);  // Newton on ln(sum) - ln(b)
    x += step;
    if (std::abs(step) <= 1e-14) break;
  }
  return std::exp(x);
}

}  // namespace detail

/// Rigid below tau_y. `epsilon` [1/s] is a smoothing for Newton's method alone; prox, which ADMM uses, is exact.
struct HerschelBulkley {
  double k = 1.0;  ///< consistency [Pa s^n]
  double n = 1.0;  ///< flow index
  double epsilon = 1e-6;

  static constexpr bool exact = true, viscous = true;
  static constexpr std::string_view word = "exact";
  static constexpr std::array<LawKey<HerschelBulkley>, 2> keys() {
    return {
        {{"mix.consistency", &HerschelBulkley::k, "Pa.s^n", "", "12 Pa.s^n",
          "k of Herschel-Bulkley, with flow_index in place of plastic_viscosity"},
         {"mix.flow_index", &HerschelBulkley::n, "", "", "1.4", "n of Herschel-Bulkley", 0.2, 2.0, false}}};
  }

  double newtonian() const { return n == 1.0 ? k : 0.0; }
  double rounded(double gamma_dot) const { return std::sqrt(gamma_dot * gamma_dot + epsilon * epsilon); }
  double secant(double gamma_dot, double tau_y) const {
    const double g = rounded(gamma_dot);
    return n == 1.0 ? tau_y / g : tau_y / g + k * std::pow(g, n - 1.0);
  }
  double slope(double gamma_dot, double tau_y) const {
    const double g = rounded(gamma_dot), yield = -tau_y / (g * g * g);
    return n == 1.0 ? yield : yield + (n - 1.0) * k * std::pow(g, n - 3.0);
  }
  double potential(double gamma_dot, double tau_y) const {
    const double g = rounded(gamma_dot), yield = tau_y * (g - epsilon);
    return n == 1.0 ? yield : yield + k * (std::pow(g, n + 1.0) - std::pow(epsilon, n + 1.0)) / (n + 1.0);
  }
  double prox(double a, double tau_y, double r) const {
    if (n == 1.0) return std::max(0.0, a - tau_y) / r;
    return a > tau_y ? detail::power_law_root(k, n, r, a - tau_y) : 0.0;
  }
  double stress(double gamma_dot, double tau_y) const {
    return n == 1.0 ? tau_y : tau_y + k * std::pow(gamma_dot, n);
  }
  double dual_limit(double gamma_dot, double tau_y) const {
    return n == 1.0 ? tau_y : secant(gamma_dot, tau_y) * gamma_dot;
  }
  double viscosity(double gamma_dot, double) const {
    return n == 1.0 ? 0.0 : k * std::pow(std::max(gamma_dot, slowest_rate), n - 1.0);
  }
  double largest_secant(double tau_y) const {
    return tau_y > 0.0 || n < 1.0 ? unbounded : n == 1.0 ? 0.0 : k * std::pow(fastest_rate, n - 1.0);
  }
};

/// Its yield stress regularised after Papanastasiou, and its viscosity bounded at rest by the same parameter m:
/// f = tau_y (1 - e^{-m gamma_dot}) + k (gamma_dot^2 + 1/m^2)^((n - 1)/2) gamma_dot.
struct RegularisedHerschelBulkley {
  double k = 1.0;  ///< consistency [Pa s^n]
  double n = 1.0;  ///< flow index
  double m = 5.0;  ///< regularisation parameter [s]

  static constexpr bool exact = false, viscous = true;
  static constexpr std::string_view word = "papanastasiou";
  static constexpr std::array<LawKey<RegularisedHerschelBulkley>, 3> keys() {
    using L = RegularisedHerschelBulkley;
    return {{{"mix.consistency", &L::k, "Pa.s^n", "", "12 Pa.s^n", "k of Herschel-Bulkley"},
             {"mix.flow_index", &L::n, "", "", "1.4", "n of Herschel-Bulkley", 0.2, 2.0, false},
             {"model.regularisation", &L::m, "s", "5 s", "5 s", "m"}}};
  }

  double newtonian() const { return n == 1.0 ? k : 0.0; }
  double power(double gamma_dot) const {  // the bounded viscosity
    return n == 1.0 ? 0.0 : k * std::pow(gamma_dot * gamma_dot + 1.0 / (m * m), 0.5 * (n - 1.0));
  }
  double secant(double gamma_dot, double tau_y) const {
    return Papanastasiou{m}.secant(gamma_dot, tau_y) + power(gamma_dot);
  }
  double slope(double gamma_dot, double tau_y) const {
    return Papanastasiou{m}.slope(gamma_dot, tau_y) +
           (n - 1.0) * power(gamma_dot) / (gamma_dot * gamma_dot + 1.0 / (m * m));
  }
  double potential(double gamma_dot, double tau_y) const {
    const double x = gamma_dot * gamma_dot, e = 1.0 / (m * m), half = 0.5 * (n + 1.0);
    if (n == 1.0) return Papanastasiou{m}.potential(gamma_dot, tau_y);
    return Papanastasiou{m}.potential(gamma_dot, tau_y) +
           k * (std::pow(x + e, half) - std::pow(e, half)) / (n + 1.0);
  }
  /// f grows, so the root is bracketed; Newton's method, and the middle where it would leave the bracket.
  double prox(double a, double tau_y, double r) const {
    if (n == 1.0 || a <= 0.0) return Papanastasiou{m}.prox(a, tau_y, r);
    double low = 0.0, high = a / r, d = std::min(high, a / (secant(0.0, tau_y) + r));
    for (int i = 0; i < 100; ++i) {
      const double excess = stress(d, tau_y) + r * d - a;
      (excess < 0.0 ? low : high) = d;
      const double growth = secant(d, tau_y) + slope(d, tau_y) * d * d + r, next = d - excess / growth;
      const double before = d;
      d = next > low && next < high ? next : 0.5 * (low + high);
      if (std::abs(d - before) <= 1e-14 * d) break;
    }
    return d;
  }
  double stress(double gamma_dot, double tau_y) const { return secant(gamma_dot, tau_y) * gamma_dot; }
  double dual_limit(double gamma_dot, double tau_y) const {
    return n == 1.0 ? tau_y : stress(gamma_dot, tau_y);
  }
  double viscosity(double gamma_dot, double) const { return power(gamma_dot); }
  double largest_secant(double tau_y) const { return m * tau_y + std::max(power(0.0), power(fastest_rate)); }
};

}  // namespace tremie
