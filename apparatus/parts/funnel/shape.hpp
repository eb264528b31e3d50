#pragma once

// The inside of a funnel that concrete leaves through its mouth: from the top down a pipe, a taper and a throat, each of which
// may be missing. Lengths in m; heights from the mouth.

#include <vector>

#include "libmpm/boundary/boundary_points.hpp"
#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/boundary/wall_strips.hpp"
#include "libmpm/constitutive/mix.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie::funnel {

/// Inner dimensions [m].
struct Shape {
  double top = 0.0, mouth = 0.0;                 ///< diameters, or widths between two side walls
  double pipe = 0.0, taper = 0.0, throat = 0.0;  ///< heights
  double depth = 0.0;                            ///< between two side walls; 0: round
};

/// One of its parts, from its lower to its upper end.
struct Part {
  double from, to;             ///< heights
  double half_low, half_high;  ///< radius or half width at both ends
};

inline double height(const Shape& shape) { return shape.pipe + shape.taper + shape.throat; }

/// The parts that it has, from the mouth up.
std::vector<Part> parts_of(const Shape& shape);

/// Radius or half width at a height.
double half_width(const Shape& shape, double z);

/// Concrete that it holds [m^3].
double volume(const Shape& shape);

/// Fills the section with points under hydrostatic pressure, rows about `dz` high of points about `dx` apart that end at the
/// wall, so that the volume is the funnel's to round-off.
void fill(const Shape& shape, const Mix& mix, double g, double dx, double dz, Points<2>& points);

/// Points on the wall, at most `spacing` apart, to which the concrete sticks or along which it slips.
std::vector<BoundaryPoint<2>> wall_points(const Shape& shape, double spacing, bool slips);

/// The same wall as strips, for a wall law that holds with a stress.
std::vector<WallStrip<2>> wall_strips(const Shape& shape, double spacing);

/// The wall as a distance, for what must stay on its side of it.
RigidWall<2> wall_of(const Shape& shape, double reach);

}  // namespace tremie::funnel
