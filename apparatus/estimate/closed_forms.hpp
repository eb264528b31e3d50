#pragma once

// Closed forms for a yield-stress fluid that was poured out of a mould and rests on a floor that holds it. SI units.

namespace tremie::estimate {

/// Yield stress of a thin layer: tau_0 = 225 rho g V^2/(128 pi^2 R^5) (Roussel and Coussot, J. Rheol. 49, 2005), spread 2 R.
double thin_layer_yield_stress(double spread, double density, double volume);

/// With the normal stress of the extending plug: the profile of `rest_radius`, solved for tau_0.
double plug_yield_stress(double spread, double density, double volume);

}  // namespace tremie::estimate
