#pragma once

// The shape of a yield-stress fluid that was poured onto a floor that holds it and rests: h^2/2 - a l h = l (R - r), with
// l = tau_0/(rho g) and a = sqrt(3) pi/4 for the normal stress of the extending plug (von Mises, equi-biaxial extension). Its
// front is a step of height 2 a l.

namespace tremie::parts {

/// The volume [m^3] under the profile of radius R [m], l [m].
double rest_volume(double l, double R);

/// The radius [m] at which a volume [m^3] rests; l > 0.
double rest_radius(double volume, double l);

}  // namespace tremie::parts
