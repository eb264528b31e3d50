#pragma once

// One explicit step of the material point method, from top to bottom.

#include "libmpm/contact/impulses.hpp"
#include "libmpm/step/explicit_nodes.hpp"
#include "libmpm/step/explicit_parts.hpp"
#include "libmpm/step/explicit_single.hpp"
#include "libmpm/step/wall_cells.hpp"

namespace tremie {

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
  const detail::PassInput input{.impulse_dt = state.next_dt};
  look_into_wall_cells(state);
  if (settings.stress == StressUpdate::last)
    detail::pass_over_points<detail::first_sums, Space>(body.mix, law, settings, input, state);
  else
    detail::pass_over_points<detail::first_momenta, Space>(body.mix, law, settings, input, state);
  return state;
}

namespace detail {

/// The controls' part of a step, then a pass over the points. Each thread goes from its controls to its
/// points at once, unless `between`, if it is wanted, must see all controls first.
template <Pass pass, class Space, class Law, class Controls, class Between>
PassSums controls_then_points(const Body<Space>& body, const Law& law, const ExplicitSettings& settings,
                              const PassInput& input, ExplicitState<Space>& state, Controls controls,
                              bool wanted, Between between) {
  if (wanted) {
    for_each_share(state.grid, controls);
    between();
  }
  look_into_wall_cells(state);
  return pass_over_points<pass, Space>(body.mix, law, settings, input, state, [&](Share<Space::dim>& share) {
    if (!wanted) controls(share);
  });
}

}  // namespace detail

/// Updates the stress last (USL): the velocities at the end of the step deform and move the points. Points to
/// grid for the step to come happens in the same pass, with the impulses that the new stresses give in it.
template <class Space, class Law>
detail::PassSums stress_last(Body<Space>& body, const Law& law, const ExplicitSettings& settings,
                             const RigidWall<Space::dim>& wall, double dt, ExplicitState<Space>& state) {
  const Vec<Space::dim> pull = dt * body.gravity, none = Vec<Space::dim>::Zero();
  const double friction = settings.friction_coefficient;
  // Momentum balance on the grid; the stresses' impulses are in the momenta, but for FLIP.
  const bool sort = detail::should_sort(state);
  const RowsOf rows_of = wall || sort ? RowsOf::all_tiles : RowsOf::own_tiles;
  const auto velocities = [&](Share<Space::dim>& share) {
    const bool flip = settings.transfer.flip;
    detail::velocities_from_sums(body, state, flip ? 0.0 : friction, flip ? none : pull, rows_of, share);
    if (flip) detail::add_impulses(body, state, friction, state.grid.forces, flip, pull, rows_of, share);
  };
  const auto wall_and_sorting = [&] {
    detail::push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
    if (sort) detail::sort_points(settings, state);
  };
  // Grid to points, stress, motion, points to grid.
  return detail::controls_then_points<detail::whole_pass>(body, law, settings, {dt, state.next_dt}, state,
                                                          velocities, wall || sort, wall_and_sorting);
}

/// Updates the stress first (USF), the paper's order: with the points' velocities as the grid has them before
/// the forces act.
template <class Space, class Law>
detail::PassSums stress_first(Body<Space>& body, const Law& law, const ExplicitSettings& settings,
                              const RigidWall<Space::dim>& wall, double dt, ExplicitState<Space>& state) {
  const Vec<Space::dim> pull = dt * body.gravity, none = Vec<Space::dim>::Zero();
  const bool sort = detail::should_sort(state);
  const RowsOf rows_of = wall || sort ? RowsOf::all_tiles : RowsOf::own_tiles;
  const auto velocities = [&](Share<Space::dim>& share) {
    detail::velocities_from_sums(body, state, 0.0, none, rows_of, share);
  };
  detail::PassSums sums = detail::controls_then_points<detail::stress_pass>(
      body, law, settings, {dt, dt}, state, velocities, sort, [&] { detail::sort_points(settings, state); });

  const auto impulses = [&](Share<Space::dim>& share) {
    const auto add = [&](const auto& sums_of_tiles) {
      detail::add_impulses(body, state, settings.friction_coefficient, sums_of_tiles, settings.transfer.flip,
                           pull, rows_of, share);
    };
    state.grid.single ? add(state.grid.single_sums) : add(state.grid.sums);
  };
  sums.add(detail::controls_then_points<detail::motion_pass>(
      body, law, settings, {dt, 0.0}, state, impulses, bool{wall},
      [&] { detail::push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state); }));
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
