#pragma once

// What is read off the concrete: spread and height.

#include "libmpm/particles/particles.hpp"

namespace tremie::cone {

/// Twice the outermost point's radius [m].
double spread_of_outermost_point(const Points<2>& points);

/// Diameter of the outline seen from above [m]: twice the radius of the outermost point that is no stray,
/// plus the size of that point. `cell`: cell size across [m], the scale on which a point far from all others
/// is a stray.
double spread(const Points<2>& points, double cell);

/// Height of the concrete at its centre [m]: of the points within `radius` of the axis, likewise robust.
double centre_height(const Points<2>& points, double radius);

/// The same of a body in space with its axis at x = y = 0; `quarter`: the points of its first quadrant. The
/// diameter is the mean over pairs of perpendicular diameters, each the distance of two parallel rulers that
/// touch the outline: turned about, as nothing favours a direction.
double spread_of_outermost_point(const Points<3>& points);
double spread(const Points<3>& points, double cell, bool quarter);
double centre_height(const Points<3>& points, double radius);

/// Mean distance of the concrete from the axis [m].
double mean_distance(const Points<2>& points);
double mean_distance(const Points<3>& points);

}  // namespace tremie::cone
