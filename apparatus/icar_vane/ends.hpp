#pragma once

// The vane with its ends: cylindrical coordinates that turn with it, one blade's sector all around, from the container's
// floor to the free surface. Steady flow without inertia at each speed (libmpm/implicit/steady/steady_flow.hpp).
//
// The floor and the container's wall hold the concrete, or a layer slides along them; its surface is flat and slips, so that
// there is no vortex and no wave. Container, blades' tips and the blades' height lie on faces of the grid; gaps and shaft are
// moved to the nearest face, at most half a cell away. A blade thinner than half a cell is a sheet. Concrete within a cell of
// the axis, below the shaft, is left out: its torque is 1e-3 of the ends' or less.
//
// Blades of 3 mm take 3 % more than sheets, and cells of 9 mm lose 1 % in the plane section; the ends feel the blades by 0.8 %.
// So the torque is that of the plane section on cells that resolve the blades, times the end factor: torque of the space
// over that of its plane section on the same cells.

#include "apparatus/icar_vane/icar_vane.hpp"
#include "libmpm/implicit/steady/steady_flow.hpp"

namespace tremie::icar_vane {

/// The grid of a vane with ends, or of its plane section: two cells high, between ends that slip.
struct EndsGrid {
  double sector = 0.0;           ///< one blade's share [rad]
  std::array<double, 3> cell{};  ///< [m], [rad], [m]
  double inner = 0.0;            ///< where the radial axis begins, less than a cell [m]
  int n_shaft = 0, n_blade = 0,
      n_radial = 0;               ///< cells from there to the shaft's face, the tips, the container
  int n_thick = 0, n_around = 0;  ///< cells across the blade and around
  int n_bottom = 0, n_height = 0, n_cover = 0;  ///< cells below, along and above the blades; no ends: 0, 2, 0

  EndsGrid(const Scene& scene, bool with_ends);

  double shaft_radius() const { return inner + n_shaft * cell[0]; }
  double bottom_gap() const { return n_bottom * cell[2]; }
  double cover() const { return n_cover * cell[2]; }
  int n_cells() const { return n_radial * n_around * (n_bottom + n_height + n_cover); }
};

/// Torques of a steady flow [N m] about the axis.
struct SteadyTorques {
  double blades = 0.0, wall = 0.0, power = 0.0;  ///< on blades and shaft, on container and floor, power/Omega
  double slip = 0.0;                             ///< mean speed along the container [m/s]
  SolveReport solve;
};

/// One blade's sector of the vane, at rest.
SteadyBody steady_body(const Scene& scene, const EndsGrid& grid);

/// Solves at a speed [rev/s], not 0, from the last solution; all torques are the whole vane's.
SteadyTorques turn_steadily(const Scene& scene, const EndsGrid& grid, double speed, SteadyBody& body);

/// The plane section at rest: on the cells of the space, and on cells that resolve blades and gap.
struct PlaneSections {
  SteadySection on_cells, resolved;
};
PlaneSections plane_sections(const Scene& scene);

/// Torques of the plane section times the vane's height [N m].
struct PlaneTorques {
  double on_cells = 0.0, resolved = 0.0;
  bool converged = false;
};
PlaneTorques turn_steadily(const Scene& scene, double speed, PlaneSections& sections);

/// Runs the test: as icar_vane::run.
Outcome run_with_ends(const Scene& scene, const scene::Observer& observer);

scene::SizeEstimate estimate_with_ends(const Scene& scene);

}  // namespace tremie::icar_vane
