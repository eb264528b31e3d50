#pragma once

// alpha read off a torque decay the paper's way, equations (5) and (6). Shear localises while the material
// breaks down, so the number depends on what is called the shear rate and on the window; it is reported as
// apparent.

#include <optional>
#include <span>

#include "rheometer/fits/fit.hpp"

namespace tremie {

/// The apparent lambda of a torque: (T - T_offset)/(2 pi R_i^2 h tau_0).
double apparent_lambda(double torque, double offset_torque, double tau_0, const Instrument& instrument);

/// Exponent c [1/s] of lambda = a e^(-c t), by the least squares in ln(lambda) over 0 <= t <= window;
/// readings with lambda <= 0 are left out. Empty for fewer than 3 readings or a single time.
std::optional<double> exponential_coefficient(std::span<const double> time, std::span<const double> lambda,
                                              double window);

}  // namespace tremie
