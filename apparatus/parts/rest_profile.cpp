#include "apparatus/parts/rest_profile.hpp"

#include <cmath>
#include <numbers>

namespace tremie::parts {

constexpr double pi = std::numbers::pi;
const double a = std::sqrt(3.0) * pi / 4.0;

// A disc of height 2 a l, and above it, with s = h - a l, the radius r = R - (s^2 - (a l)^2)/(2 l) from s = a l to r = 0.
double rest_volume(double l, double R) {
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

double rest_radius(double volume, double l) {
  double low = 0.0, high = std::cbrt(volume);
  while (rest_volume(l, high) < volume) high *= 2.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (rest_volume(l, middle) < volume ? low : high) = middle;
  }
  return high;
}

}  // namespace tremie::parts
