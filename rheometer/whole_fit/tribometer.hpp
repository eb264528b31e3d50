#pragma once

// The interface law of a smooth wall, tau = tau_i + k_i u, from a tribometer: a smooth cylinder that turns in concrete at
// one or more fill heights (Ngo et al. 2010; Feys et al. 2014). The torque grows with the fill height by the side alone,
// 2 pi R^2 tau of a metre; what is left at no height, a + b Omega, is the ends'. The concrete's own shear, where its yield
// stress and viscosity are known, takes its part of the speed off: u = R (Omega - Omega of the concrete at this stress).
// The same holds with the container's radius where a vane or a rough cylinder turns in a smooth container.

#include <string>
#include <vector>

#include "rheometer/fits/fit.hpp"
#include "rheometer/fits/parameters.hpp"

namespace tremie {

/// Torques over speeds at one fill height.
struct TribometerSeries {
  double fill_height = 0.0;  ///< of the concrete along the cylinder's side [m]
  TorqueRecord record;
};

enum class SmoothWall { cylinder, container };

/// tau_i and k_i of the smooth wall with their intervals. input.instrument has the cylinder's radius and the container's; the
/// wall that is not smooth holds the concrete without slip. tau_0 and mu, both or none, are the concrete's. At one fill height the ends' torque counts as the
/// side's, and a note says so. The curve is the side's at the first fill height. Throws std::invalid_argument for fewer
/// than two speeds, a decay, a fill height that is not positive, one of tau_0 and mu alone.
FitResult fit_tribometer(const std::vector<TribometerSeries>& series, const FitInput& input,
                         SmoothWall wall = SmoothWall::cylinder);

/// "100 mm; 150 mm" [m]. Throws std::invalid_argument that names what is no length.
std::vector<double> fill_heights(const std::string& text);

}  // namespace tremie
