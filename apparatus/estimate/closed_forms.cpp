#include "apparatus/estimate/closed_forms.hpp"

#include <cmath>
#include <numbers>

#include "apparatus/parts/rest_profile.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::estimate {

double thin_layer_yield_stress(double spread, double density, double volume) {
  constexpr double pi = std::numbers::pi;
  return 225.0 * density * gravity * volume * volume / (128.0 * pi * pi * std::pow(0.5 * spread, 5));
}

double plug_yield_stress(double spread, double density, double volume) {
  double low = 1e-9, high = 1.0;  // l [m]; the volume grows with it
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (parts::rest_volume(middle, 0.5 * spread) < volume ? low : high) = middle;
  }
  return low * density * gravity;
}

}  // namespace tremie::estimate
