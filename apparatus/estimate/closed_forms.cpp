#include "apparatus/estimate/closed_forms.hpp"

#include <cmath>
#include <numbers>

#include "libmpm/constitutive/constants.hpp"

namespace tremie::estimate {
namespace {

constexpr double pi = std::numbers::pi;
const double a = std::sqrt(3.0) * pi / 4.0;

/// The volume under the rest profile: a disc of height 2 a l, and above it, with s = h - a l, the radius
/// r = R - (s^2 - (a l)^2)/(2 l) from s = a l to r = 0.
double volume(double l, double R) {
  const double b = a * l, top = std::sqrt(b * b + 2.0 * l * R);
  constexpr int n = 200;  // Simpson; the integrand is a polynomial of degree four
  const double ds = (top - b) / n;
  double sum = 0.0;
  for (int i = 0; i <= n; ++i) {
    const double s = b + i * ds, r = R - (s * s - b * b) / (2.0 * l);
    sum += (i == 0 || i == n ? 1.0 : i % 2 ? 4.0 : 2.0) * r * r;
  }
  return pi * (2.0 * b * R * R + sum * ds / 3.0);
}

}  // namespace

double thin_layer_yield_stress(double spread, double density) {
  return 225.0 * density * gravity * cone_volume * cone_volume /
         (128.0 * pi * pi * std::pow(0.5 * spread, 5));
}

double plug_yield_stress(double spread, double density) {
  double low = 1e-9, high = 1.0;  // l [m]; the volume grows with it
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (volume(middle, 0.5 * spread) < cone_volume ? low : high) = middle;
  }
  return low * density * gravity;
}

}  // namespace tremie::estimate
