#pragma once

// The spaces that implicit steps are compiled for: M(Geometry) for each of them.

#include "libmpm/geometry/polar.hpp"

#define TREMIE_IN_SECTIONS(M) M(Axisymmetric) M(PlaneStrain)
#ifdef TREMIE_SECTIONS_ONLY  // the page for the browser has no vane and nothing in space
#define TREMIE_IN_ALL_SPACES(M) TREMIE_IN_SECTIONS(M)
#else
#define TREMIE_IN_ALL_SPACES(M) TREMIE_IN_SECTIONS(M) M(Couette) M(Polar) M(ThreeD)
#endif
