#pragma once

// What implicit steps need beside the body: their settings, the solver's state that goes on from one step to the
// next, and what a step reports.

#include <optional>
#include <type_traits>
#include <vector>

#include "libmpm/body/body.hpp"
#include "libmpm/boundary/wall_law.hpp"
#include "libmpm/boundary/wall_strips.hpp"
#include "libmpm/implicit/shifting/particle_shifting_3d.hpp"
#include "libmpm/implicit/solvers/admm_factorised.hpp"
#include "libmpm/implicit/solvers/admm_matrix_free.hpp"
#include "libmpm/implicit/solvers/newton.hpp"

namespace tremie {

/// What a section's cells weigh.
enum class WeightRule {
  points,  ///< what their points weigh
  balanced_inside,  ///< cells inside the body what a full cell does, where its stresses are integrated; others their points
  balanced  ///< every cell what a full one does
};

enum class YieldMethod { automatic, admm, newton };

struct StepSettings {
  YieldMethod method = YieldMethod::automatic;
  AdmmSettings admm;
  NewtonSettings newton;
  Transfer transfer;
  ParticleShifting particle_shifting;
  std::optional<double> fixed_dt;  ///< [s]; empty: chosen at every step
  double dt_max = 0.1;             ///< [s]
  double time_error = 0.0;   ///< local error allowed to steps longer than dt_max, in cells; 0: none is longer
  double dt_longest = 1.0;   ///< the longest such step [s]
  double time_left = 1e300;  ///< no step goes beyond it [s]
  double cfl = 0.6;          ///< largest move in a step, in cells
  double growth = 1.3;       ///< largest ratio of successive steps
  double detached = 0.0;     ///< share of the points that may be drops in the air (detached_particles.hpp)
  WallLaw wall_law;          ///< along faces of FaceKind::wall_law
  bool keep_forces = false;  ///< fill Body::wall_force and Body::dissipation
  double boundary_stiffness = 1000.0;  ///< of walls inside the grid, in nodal mass over dt
  double alternating_viscosity = 0.0;  ///< zeta of yield_problem.hpp, over the cell's viscosity
  bool cut_cell_rule =
      false;  ///< stresses of partly filled cells where the points are; in 3D films hold on their walls
  bool settle_on_floor = false;  ///< partly filled cells on the floor are full from below (mpm_step.md)
  WeightRule weight = WeightRule::points;  ///< gravity on a section (cell_weights.hpp)
  bool moving_surface = false;             ///< gravity where the step leaves the free surface
  double side_wall_distance = 0.0;  ///< of a width-averaged section [m]; 0: plane strain, no side walls
  double wall_gap = 0.0;            ///< how near a point may come to a rigid wall [m]
  double wall_penalty = 100.0;      ///< stiffness of a rigid wall, in nodal mass over dt
};

/// A body with what its implicit steps carry over from one to the next.
template <class Geometry>
struct ImplicitBody : Body<Geometry> {
  static constexpr int D = Geometry::dim;
  Quadrature<Geometry> quadrature{};
  AdmmState<Geometry> admm_state{};
  // Wall terms of the last step where there was concrete:
  std::vector<NodeTerm<D>> wall_nodes{};  ///< along flat walls and between side walls
  std::vector<PointTerm<D>> bound{};      ///< walls inside the grid
  std::vector<PointTerm<D>> bar_drag{};   ///< bars, and strips of walls
  std::vector<WallStrip<D>> strips{};     ///< walls inside the grid along which the wall law holds
  double time_error = 0.0;                ///< of the last step: its local error, if it was asked for [m]
  double shear_rate = 0.0;                ///< volume mean of the last step [1/s]
  BlockSystem<D> system{};
  std::conditional_t<D == 3, MatrixFreeSystem, Nothing> matrix_free{};  ///< for large bodies in 3D
};

struct StepReport {
  double dt = 0.0;  ///< [s]
  bool converged = false;
  bool failed = false;  ///< the velocities are not finite or run away: the points were left where they were
  int iterations = 0;   ///< linear solves
  double max_speed = 0.0;        ///< of the points [m/s]
  double bulk_speed = 0.0;       ///< of all but the fastest half percent of the points [m/s]
  double shear_rate_mean = 0.0;  ///< volume mean [1/s]
};

}  // namespace tremie
