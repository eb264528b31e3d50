#pragma once

// Yield stress from a spread by closed forms for a yield stress fluid at rest, in SI units, for the volume of
// the Abrams cone.

namespace tremie::estimate {

inline constexpr double cone_volume = 5.497787143782138e-3;  ///< pi 0.3 (0.05^2 + 0.05 0.1 + 0.1^2)/3 [m^3]

/// Thin layer: tau_0 = 225 rho g V^2/(128 pi^2 R^5) (Roussel and Coussot, J. Rheol. 49, 2005), spread 2 R.
double thin_layer_yield_stress(double spread, double density);

/// With the normal stress of the extending plug: the rest profile h^2/2 - a l h = l (R - r), l = tau_0/(rho g),
/// a = sqrt(3) pi/4 (von Mises, equi-biaxial extension), solved for tau_0. Its front is a step of height 2 a l.
double plug_yield_stress(double spread, double density);

}  // namespace tremie::estimate
