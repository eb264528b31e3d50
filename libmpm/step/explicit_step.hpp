#pragma once

// One explicit step of the material point method, from top to bottom.

#include "libmpm/contact/impulses.hpp"
#include "libmpm/step/explicit_nodes.hpp"
#include "libmpm/step/explicit_parts.hpp"
#include "libmpm/step/explicit_single.hpp"
#include "libmpm/step/wall_cells.hpp"

namespace tremie {

namespace detail {

/// A pass over the points for run_passes: `of_block(block)` makes the velocities that it reads.
template <Pass pass, class Space, class Law, class OfBlock>
auto controls_to_points(bool controls_done, OfBlock of_block, PointsPass<pass, Space, Law>& of_tile) {
  return GridPass{controls_done, [of_block](int block) { of_block(static_cast<std::size_t>(block)); },
                  [&of_tile](int tile) { of_tile(tile); }};
}

/// A pass over the points, with the velocities that the controls have.
template <Pass pass, class Space, class Law>
PassSums pass_over_points(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                          const PassInput& input, ExplicitState<Space>& state) {
  const auto no_change = [](std::size_t) {};
  PointsPass<pass, Space, Law> of_tile{mix, law, settings, input, state};
  run_passes(state.grid, controls_to_points(true, no_change, of_tile));
  return of_tile.sums();
}

}  // namespace detail

/// Sorts the body's points into tiles and brings their mass, momentum and first stresses to the grid.
/// body.points is empty from here to the next write_back.
template <class Space, class Law>
ExplicitState<Space> start_explicit(Body<Space>& body, const Law& law, const ExplicitSettings& settings,
                                    const Shape<Space::dim>& shape) {
  ExplicitState<Space> state;
  state.shape = shape;
  state.grid.axes = body.grid.axes;
  state.grid.single = settings.single_precision;
  for (double lambda : body.points.lambda) state.lambda_max = std::max(state.lambda_max, lambda);
  take_points<Space::dim>(body.points, !settings.transfer.flip, settings.keep_shear_rates, state.points);
  detail::sort_points(settings, state);
  detail::choose_next_step(body, law, settings, state);
  look_into_wall_cells(state);
  const detail::PassInput input{.impulse_dt = state.next_dt};
  if (settings.stress == StressUpdate::last)
    detail::pass_over_points<detail::first_sums>(body.mix, law, settings, input, state);
  else
    detail::pass_over_points<detail::first_momenta>(body.mix, law, settings, input, state);
  if (!settings.keep_affine)
    for (std::vector<Octet>& C : state.points.C) give_back(C);
  return state;
}

/// Updates the stress last (USL): the velocities at the end of the step deform and move the points. Points to
/// grid for the step to come happens in the same pass, with the impulses that the new stresses give in it.
template <class Space, class Law>
detail::PassSums stress_last(Body<Space>& body, const Law& law, const ExplicitSettings& settings,
                             const RigidWall<Space::dim>& wall, double dt, ExplicitState<Space>& state) {
  const Vec<Space::dim> pull = dt * body.gravity, none = Vec<Space::dim>::Zero();
  const double friction = settings.friction_coefficient;
  // Momentum balance on the grid; the stresses' impulses are in the momenta, but for FLIP.
  const auto velocities = [&](std::size_t block) {
    const bool flip = settings.transfer.flip;
    detail::velocities_from_sums(body, flip ? 0.0 : friction, flip ? none : pull, block, state);
    if (flip) detail::add_impulses(body, friction, state.grid.forces, flip, pull, block, state);
  };
  const bool sort = detail::should_sort(state), all_at_once = wall || sort;
  if (all_at_once) for_each_block(state.grid, velocities);
  detail::push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
  if (sort) detail::sort_points(settings, state);
  look_into_wall_cells(state);
  // Grid to points, stress, motion, points to grid.
  detail::PointsPass<detail::whole_pass, Space, Law> whole{
      body.mix, law, settings, {dt, state.next_dt}, state};
  run_passes(state.grid, detail::controls_to_points(all_at_once, velocities, whole));
  return whole.sums();
}

/// Updates the stress first (USF), the paper's order: with the points' velocities as the grid has them before
/// the forces act.
template <class Space, class Law>
detail::PassSums stress_first(Body<Space>& body, const Law& law, const ExplicitSettings& settings,
                              const RigidWall<Space::dim>& wall, double dt, ExplicitState<Space>& state) {
  const Vec<Space::dim> pull = dt * body.gravity, none = Vec<Space::dim>::Zero();
  const auto velocities = [&](std::size_t block) {
    detail::velocities_from_sums(body, 0.0, none, block, state);
  };
  const auto impulses = [&](std::size_t block) {
    const auto add = [&](const auto& of_tiles) {
      detail::add_impulses(body, settings.friction_coefficient, of_tiles, settings.transfer.flip, pull, block,
                           state);
    };
    state.grid.single ? add(state.grid.single_sums) : add(state.grid.sums);
  };
  const bool sort = detail::should_sort(state);
  if (sort) {
    for_each_block(state.grid, velocities);
    detail::sort_points(settings, state);
  }
  look_into_wall_cells(state);
  detail::PointsPass<detail::stress_pass, Space, Law> stress{body.mix, law, settings, {dt, dt}, state};
  detail::PointsPass<detail::motion_pass, Space, Law> motion{body.mix, law, settings, {dt, 0.0}, state};
  const auto first = detail::controls_to_points(sort, velocities, stress);
  const auto second = detail::controls_to_points(bool{wall}, impulses, motion);
  if (wall) {
    run_passes(state.grid, first);
    for_each_block(state.grid, impulses);
    detail::push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
    run_passes(state.grid, second);
  } else {
    run_passes(state.grid, first, second);
  }
  detail::PassSums sums = stress.sums();
  sums.add(motion.sums());
  return sums;
}

/// Advances the body by one step. Its points are left on the tiles: write_back brings them to body.points.
template <class Space, class Law>
ExplicitReport explicit_step(Body<Space>& body, const Law& law, const ExplicitSettings& settings,
                             ExplicitState<Space>& state, const RigidWall<Space::dim>& wall = {}) {
  ExplicitReport report;
  const double dt = state.next_dt;
  report.dt = dt;
  report.limits = state.limits;
  report.beyond_limit = dt > state.limits.viscous || dt > state.limits.acoustic;
  detail::choose_next_step(body, law, settings, state);

  const detail::PassSums sums = settings.stress == StressUpdate::last
                                    ? stress_last(body, law, settings, wall, dt, state)
                                    : stress_first(body, law, settings, wall, dt, state);
  body.time += dt;
  body.dt = dt;
  report.failed = sums.ran_away;
  report.max_speed = state.max_speed = std::sqrt(sums.speed2);
  report.shear_rate_mean = sums.volume > 0.0 ? sums.volume_rate / sums.volume : 0.0;
  state.lambda_max = sums.lambda;
  state.drift += sums.farthest;
  state.holding.drift += sums.farthest;
  state.wall_drift += sums.farthest * body.grid.axes[0].h + settings.wall_speed * dt;
  return report;
}

}  // namespace tremie
