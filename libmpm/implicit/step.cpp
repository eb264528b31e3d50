// One backward-Euler step of the material point method, from top to bottom.

#include "libmpm/implicit/step.hpp"

#include <optional>

#include "libmpm/implicit/detached_particles.hpp"
#include "libmpm/implicit/pose.hpp"
#include "libmpm/implicit/solve.hpp"
#include "libmpm/implicit/step_size.hpp"
#include "libmpm/implicit/update.hpp"

namespace tremie {

/// How often a step that does not converge is tried, each time over half the time.
inline constexpr int most_attempts = 4;

template <class Geometry>
StepReport implicit_step(ImplicitBody<Geometry>& body, const YieldLaw& law, const StepSettings& settings,
                         const RigidWall<Geometry::dim>& wall) {
  constexpr int D = Geometry::dim;
  IndexMap<D> old_cells = std::move(body.grid.cell_map), old_nodes;
  if (!body.friction.empty()) old_nodes = std::move(body.grid.node_map);

  // Points to grid.
  activate(body.grid, body.points.x);
  point_to_grid(body.grid, body.points, body.nodes);
  if constexpr (D == 3) release(body.points.C);  // the grid has it now, and gives another one back
  detail::carry_over_admm_state(old_cells, law, settings, body);
  old_cells = {};
  lay_out_quadrature<Geometry>(body.grid, body.points, body.mix.tau_0, body.mix.K, body.quadrature,
                               settings.cut_cell_rule, settings.settle_on_floor);

  // The step's convex problem and its solution, the velocities at the end of the step. One that does not
  // converge is tried again over half the time; so is a long one in which something starts to fall. The last try is
  // kept, unless it runs away.
  const std::vector<Vec<D>> v_old = body.nodes.v;
  const int attempts = settings.fixed_dt ? 1 : most_attempts;
  std::optional<AdmmState<Geometry>> guess;
  if (attempts > 1 && !detail::by_iteration(body, settings)) guess = body.admm_state;
  std::optional<YieldProblem<Geometry>> posed;
  SolveReport solve;
  double dt = detail::choose_dt(body, settings);
  bool good = false;
  for (int attempt = 0; attempt < attempts && !good; ++attempt) {
    if (attempt > 0) detail::guess_again(guess, settings, dt, body), dt *= 0.5;
    detail::pose(body, law, settings, wall, v_old, old_nodes, dt, posed);
    solve = detail::solve_step(*posed, law, settings, body);
    const bool falls =
        !settings.fixed_dt && dt > settings.dt_max && detail::starts_to_fall(body, settings, dt);
    good = solve.converged && !falls;
  }
  guess.reset();
  const YieldProblem<Geometry>& problem = *posed;
  if (detail::runs_away(body, settings.detached, dt)) {
    body.v = v_old;
    if constexpr (D == 3) affine_from_grid<D>(body.grid, v_old, body.points);
    return {.dt = dt, .converged = false, .failed = true, .iterations = solve.iterations};
  }
  body.friction = problem.friction;
  body.bound = problem.bound;
  body.bar_drag = problem.bars;
  if (settings.keep_forces) detail::keep_forces(problem, law, body);

  release(posed->contact);

  // Grid to points: state first, where the points were, then the move.
  if (body.points.thixotropic()) detail::update_flocculation(body, dt, body.points);
  detail::update_volumes(problem, body.v, body.points);
  std::vector<double> gamma_dot;
  body.shear_rate = detail::shear_rates(problem, settings, body, gamma_dot);
  const bool even = Geometry::advects && settings.particle_shifting.on, measured = settings.time_error > 0.0;
  const std::vector<Vec<D>> u =
      even ? detail::particle_shift(problem, settings, gamma_dot, body) : std::vector<Vec<D>>{};
  if constexpr (D == 3)
    if (detail::by_iteration(body, settings) && body.matrix_free.release()) {
      body.quadrature = {};
      release_free_heap();
    }
  const std::vector<Vec<D>> v_before = measured ? body.points.v : std::vector<Vec<D>>{};
  const std::vector<Vec<D>> from = settings.detached > 0.0 ? body.points.x : std::vector<Vec<D>>{};
  grid_to_point(body.grid, body.v, v_old, settings.transfer, Geometry::advects ? dt : 0.0, body.points,
                body.motion);
  if (settings.detached > 0.0) hold_detached_particles<D>(body.grid.axes, dt, from, body.points);
  if (even) shift_points<D>(body.grid, u, body.points, body.motion);
  body.time += dt;
  body.dt = dt;
  if (measured) body.time_error = detail::local_error(body.points, v_before, dt);

  const auto speed = [&](std::size_t p) { return body.points.v[p].norm(); };
  return {.dt = dt,
          .converged = solve.converged,
          .iterations = solve.iterations,
          .max_speed = detail::max_speed(body.points),
          .bulk_speed = detail::speed_of_most(body.points, detail::detached_share, speed),
          .shear_rate_mean = body.shear_rate};
}

template StepReport implicit_step(ImplicitBody<Axisymmetric>&, const YieldLaw&, const StepSettings&,
                                  const RigidWall<2>&);
template StepReport implicit_step(ImplicitBody<PlaneStrain>&, const YieldLaw&, const StepSettings&,
                                  const RigidWall<2>&);
#ifndef TREMIE_SECTIONS_ONLY  // the page for the browser has no vane and nothing in space
template StepReport implicit_step(ImplicitBody<Couette>&, const YieldLaw&, const StepSettings&,
                                  const RigidWall<1>&);
template StepReport implicit_step(ImplicitBody<Polar>&, const YieldLaw&, const StepSettings&,
                                  const RigidWall<2>&);
template StepReport implicit_step(ImplicitBody<ThreeD>&, const YieldLaw&, const StepSettings&,
                                  const RigidWall<3>&);
#endif

}  // namespace tremie
