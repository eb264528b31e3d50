#pragma once

// Steady flow without inertia in a container that is full of concrete, in cylindrical coordinates or in their plane section,
// polar ones: the convex problem of a step (yield_problem.hpp) without masses, and its solution by ADMM with a Cholesky factor.
//
// The flow is the same at every time and no cell is ever empty, so there are no points: every cell is full and carries
// the mix's yield stress. Bodies that carry flocculation, or whose inertia counts, need the steps.

#include "libmpm/geometry/cylindrical.hpp"
#include "libmpm/geometry/polar.hpp"
#include "libmpm/implicit/pose.hpp"
#include "libmpm/implicit/update.hpp"

namespace tremie {

using SteadyBody = ImplicitBody<Cylindrical>;
using SteadySection = ImplicitBody<Polar>;

/// Activates all cells of a grid with bounded or periodic axes alone, blocks left out, and lays out their quadrature.
template <class Geometry>
void lay_out_steady_flow(ImplicitBody<Geometry>& body);

/// Solves for the velocities at the walls' and blocks' speeds, from the stresses of the last solution; then v,
/// wall_force and dissipation of the body are those of the flow. `rate`: a typical shear rate of it [1/s], above 0.
/// `wall_law`: along faces of FaceKind::wall_law.
template <class Geometry>
SolveReport solve_steady_flow(ImplicitBody<Geometry>& body, const YieldLaw& law, const WallLaw& wall_law,
                              double rate, int max_iterations = 1000);

/// Pressure of cell c in the flow [Pa].
double steady_pressure(const SteadyBody& body, int c);

/// Velocity in the middle of a cell [m/s], and its mean shear rate [1/s].
Vec<3> velocity_in_middle(const SteadyBody& body, int c);
double shear_rate_of_cell(const SteadyBody& body, int c);

}  // namespace tremie
