// One backward-Euler step of the material point method, from top to bottom.

#include "libmpm/implicit/step.hpp"

#include <optional>
#include <type_traits>

#include "libmpm/geometry/spaces.hpp"
#include "libmpm/implicit/detached_particles.hpp"
#include "libmpm/implicit/pose.hpp"
#include "libmpm/implicit/problem/mixes.hpp"
#include "libmpm/implicit/problem/side_walls.hpp"
#include "libmpm/implicit/solve.hpp"
#include "libmpm/implicit/step_size.hpp"
#include "libmpm/implicit/update.hpp"

namespace tremie {

/// How often a step that does not converge is tried, each time over half the time.
inline constexpr int most_attempts = 4;

namespace detail {

/// The step once the points are on the grid.
template <class Form, class Geometry>
StepReport step_from_grid(ImplicitBody<Geometry>& body, const YieldLaw& law, const StepSettings& settings,
                          const RigidWall<Geometry::dim>& wall, IndexMap<Geometry::dim> old_cells,
                          const IndexMap<Geometry::dim>& old_nodes) {
  constexpr int D = Geometry::dim;
  Form::carry_over(old_cells, law, body);
  old_cells = {};
  lay_out_quadrature<Geometry>(body.grid, body.points, body.mix.tau_0, body.mix.K, body.quadrature,
                               settings.cut_cell_rule, settings.settle_on_floor);
  if (!body.mixes.empty()) lay_out_mixes<Geometry>(body.grid, body.points, body.mixes, body.quadrature);
  if constexpr (D == 2)
    if (settings.side_wall_distance > 0.0) {
      // What is at rest keeps its shares, and so does all of a body that is so in the mean, or it would go on creeping from
      // one share to the next.
      const double at_rest = settings.admm.rate_at_rest;
      const std::optional<WallStress> layer = wall_stress(settings.wall_law);
      share_yield_stress<Geometry>(
          body.grid, body.nodes.v, settings.side_wall_distance, layer ? layer->yield : unbounded,
          body.shear_rate > at_rest ? at_rest : unbounded, body.admm_state.wall_share, body.quadrature);
    }
  if constexpr (std::is_same_v<Geometry, Axisymmetric>)
    if (settings.alternating_viscosity > 0.0) lay_out_excess<Geometry>(body.grid, body.quadrature);

  // The step's convex problem and its solution, the velocities at the end of the step. One that does not
  // converge is tried again over half the time; so is a long one in which something starts to fall. The last try is
  // kept, unless it runs away.
  const std::vector<Vec<D>> v_old = body.nodes.v;
  const int attempts = settings.fixed_dt ? 1 : most_attempts;
  std::optional<AdmmState<Geometry>> guess;
  if (attempts > 1) guess = Form::first_guess(body);
  std::optional<YieldProblem<Geometry>> posed;
  SolveReport solve;
  double dt = choose_dt(body, settings);
  bool good = false;
  for (int attempt = 0; attempt < attempts && !good; ++attempt) {
    if (attempt > 0) Form::guess_again(guess, settings, dt, body), dt *= 0.5;
    pose(body, law, settings, wall, v_old, old_nodes, dt, posed);
    solve = solve_step<Form>(*posed, law, settings, body);
    const bool falls = !settings.fixed_dt && dt > settings.dt_max && starts_to_fall(body, settings, dt);
    good = solve.converged && !falls;
  }
  guess.reset();
  const YieldProblem<Geometry>& problem = *posed;
  if (runs_away(body, settings.detached, dt)) {
    body.v = v_old;
    if constexpr (D == 3) affine_from_grid<D>(body.grid, v_old, body.points);
    return {.dt = dt, .converged = false, .failed = true, .iterations = solve.iterations};
  }
  body.wall_nodes = problem.wall_nodes;
  body.bound = problem.bound;
  body.bar_drag = problem.bars;
  if (settings.keep_forces) keep_forces<Form>(problem, law, body);

  release(posed->contact);

  // Grid to points: state first, where the points were, then the move.
  if (body.points.thixotropic()) update_flocculation<Form>(problem, law, body, dt, body.points);
  update_volumes(problem, body.v, body.points);
  std::vector<double> gamma_dot;
  body.shear_rate = Form::shear_rates(problem, body, gamma_dot);
  const bool shifts = Geometry::advects && settings.particle_shifting.on,
             measured = settings.time_error > 0.0;
  std::vector<Vec<D>> shift;
  if (shifts)
    shift =
        Form::shifting(problem, cell_fill(problem, body.points, gamma_dot, settings.particle_shifting), body);
  Form::release(body);
  const std::vector<Vec<D>> v_before = measured ? body.points.v : std::vector<Vec<D>>{};
  const std::vector<Vec<D>> from = settings.detached > 0.0 || wall ? body.points.x : std::vector<Vec<D>>{};
  grid_to_point(body.grid, body.v, v_old, settings.transfer, Geometry::advects ? dt : 0.0, body.points,
                body.motion);
  if (settings.detached > 0.0) hold_detached_particles<D>(body.grid.axes, dt, from, body.points);
  if (shifts) shift_points<D>(body.grid, shift, body.points, body.motion);
  if (wall)
    keep_on_its_side<D>(wall, body.time, body.time + dt, from, 1e-3 * settings.wall_gap, body.points.x);
  body.time += dt;
  body.dt = dt;
  if (measured) body.time_error = local_error(body.points, v_before, dt);

  const auto speed = [&](std::size_t p) { return body.points.v[p].norm(); };
  return {.dt = dt,
          .converged = solve.converged,
          .iterations = solve.iterations,
          .max_speed = max_speed(body.points),
          .bulk_speed = speed_of_most(body.points, detached_share, speed),
          .shear_rate_mean = body.shear_rate};
}

}  // namespace detail

template <class Geometry>
StepReport implicit_step(ImplicitBody<Geometry>& body, const YieldLaw& law, const StepSettings& settings,
                         const RigidWall<Geometry::dim>& wall) {
  IndexMap<Geometry::dim> old_cells = std::move(body.grid.cell_map), old_nodes;
  if (!body.wall_nodes.empty()) old_nodes = std::move(body.grid.node_map);
  // Points to grid.
  activate(body.grid, body.points.x);
  point_to_grid(body.grid, body.points, body.nodes);
  if constexpr (Geometry::dim == 3) {
    release(body.points.C);  // the grid has it now, and gives another one back
    if (body.mixes.empty() && detail::by_iteration(body, settings))
      return detail::step_from_grid<detail::ByIteration>(body, law, settings, wall, std::move(old_cells),
                                                         old_nodes);
  }
  return detail::step_from_grid<detail::ByFactors>(body, law, settings, wall, std::move(old_cells),
                                                   old_nodes);
}

#define TREMIE_IMPLICIT_STEP_IN(Geometry)                                                          \
  template StepReport implicit_step(ImplicitBody<Geometry>&, const YieldLaw&, const StepSettings&, \
                                    const RigidWall<Geometry::dim>&);
TREMIE_IN_ALL_SPACES(TREMIE_IMPLICIT_STEP_IN)

}  // namespace tremie
