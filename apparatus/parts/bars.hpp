#pragma once

// Upright bars in the way of the concrete: by a drag law on cells that do not resolve them, as cylinders on cells that do.

#include <array>
#include <string>
#include <vector>

#include "apparatus/common/model.hpp"
#include "libmpm/body/body.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::parts {

/// A bar on the floor [m].
struct Bar {
  double x = 0.0, y = 0.0, diameter = 0.0, height = 0.0;
};

/// Whether cells of this size resolve a bar, two to its diameter.
inline bool resolves_bars(double cell, double diameter) { return cell <= 0.5 * diameter * (1.0 + 1e-9); }

/// The bars on cells that do not resolve them; what lies beyond a plane of symmetry at 0 is left out.
std::vector<BarPoint<3>> slender_bars(const std::vector<Bar>& bars, const std::array<Axis, 3>& axes);

/// The bars on cells that resolve them: points `spacing` apart [m] to which the concrete sticks.
void add_resolved_bars(const std::vector<Bar>& bars, double spacing, std::vector<BoundaryPoint<3>>& points);

/// Reynolds number of a bar at a speed of the concrete [m/s], with the apparent viscosity at that speed over the diameter.
double bar_reynolds(const Mix& mix, const YieldLaw& law, double speed, double diameter);

/// A reason where the drag law, which has no inertia, does not hold at a speed of the concrete [m/s]; else empty.
std::string bars_with_inertia(const Mix& mix, const YieldLaw& law, double speed, double diameter);

/// A reason where the gaps are too narrow for the cells; else empty.
std::string cells_between_bars(double cell, double diameter);

}  // namespace tremie::parts
