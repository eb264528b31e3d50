#pragma once

// What is read off the concrete: spread, height, means.

#include <optional>
#include <vector>

#include "libmpm/points/points.hpp"

namespace tremie::slump_flow {

/// Twice the outermost point's radius [m].
double spread_of_outermost_point(const Points<2>& points);

/// Diameter of the outline seen from above [m]: twice the radius of the outermost point that is no stray, plus the size
/// of that point. `cell`: cell size across [m], the scale on which a point far from all others is a stray.
double spread(const Points<2>& points, double cell);

/// Height of the concrete at its centre [m]: of the points within `radius` of the axis, likewise robust.
double centre_height(const Points<2>& points, double radius);

/// Volume mean of lambda; empty without thixotropy.
std::optional<double> mean_flocculation(const Points<2>& points);

/// sum V / sum V0 - 1, against the stress-free volume.
double volume_change(const Points<2>& points);

double total_volume(const Points<2>& points);
double total_mass(const Points<2>& points);
double kinetic_energy(const Points<2>& points);

/// Points that are not finite or lie under the floor or left of the axis.
std::int64_t points_lost(const Points<2>& points);

}  // namespace tremie::slump_flow
