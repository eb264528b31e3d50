#include "rheometer/fits/apparent_alpha.hpp"

#include <cmath>

namespace tremie {

double apparent_lambda(double torque, double offset_torque, double tau_0, const Instrument& in) {
  return shear_stress_at(in.vane_radius, torque - offset_torque, in) / tau_0;
}

std::optional<double> exponential_coefficient(std::span<const double> time, std::span<const double> lambda,
                                              double window) {
  double n = 0.0, t_mean = 0.0, y_mean = 0.0;
  const auto used = [&](std::size_t i) { return time[i] <= window * (1.0 + 1e-12) && lambda[i] > 0.0; };
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!used(i)) continue;
    n += 1.0;
    t_mean += time[i];
    y_mean += std::log(lambda[i]);
  }
  if (n < 3.0) return std::nullopt;
  t_mean /= n;
  y_mean /= n;
  double tt = 0.0, ty = 0.0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (!used(i)) continue;
    tt += (time[i] - t_mean) * (time[i] - t_mean);
    ty += (time[i] - t_mean) * (std::log(lambda[i]) - y_mean);
  }
  if (!(tt > 0.0)) return std::nullopt;
  return -ty / tt;
}

}  // namespace tremie
