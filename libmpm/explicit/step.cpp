// An explicit step of the material point method, from top to bottom.

#include "libmpm/explicit/step.hpp"

#include "libmpm/explicit/impulses.hpp"
#include "libmpm/explicit/nodes.hpp"
#include "libmpm/explicit/single_precision.hpp"
#include "libmpm/explicit/wall_fill.hpp"

namespace tremie {

template <class Geometry>
ExplicitState<Geometry> start_explicit(Body<Geometry>& body, const YieldLaw& law,
                                       const ExplicitSettings& settings, const Shape<Geometry::dim>& shape) {
  ExplicitState<Geometry> state;
  state.shape = shape;
  state.grid.axes = body.grid.axes;
  state.grid.single = settings.single_precision;
  for (double lambda : body.points.lambda) state.lambda_max = std::max(state.lambda_max, lambda);
  take_points<Geometry::dim>(body.points, !settings.transfer.flip, settings.keep_shear_rates, state.points);
  detail::sort_points(settings, state);
  detail::choose_next_step(body, law, settings, state);
  look_into_wall_cells(state);
  const detail::PassInput input{.impulse_dt = state.next_dt};
  if (settings.stress == StressUpdate::last)
    detail::pass_over_points<detail::first_sums>(body.mix, law, settings, input, state);
  else
    detail::pass_over_points<detail::first_momenta>(body.mix, law, settings, input, state);
  if (!settings.keep_affine)
    for (std::vector<f64x8>& C : state.points.C) release(C);
  return state;
}

namespace detail {

/// Updates the stress last (USL): the velocities at the end of a step deform and move the points. Points to
/// grid for the step to come happens in the same pass, with the impulses that the new stresses give in it.
template <class Geometry, class Law>
PassSums stress_last(Body<Geometry>& body, const Law& law, const ExplicitSettings& settings,
                     const RigidWall<Geometry::dim>& wall, double dt, ExplicitState<Geometry>& state) {
  const Vec<Geometry::dim> pull = dt * body.gravity, none = Vec<Geometry::dim>::Zero();
  const double friction = settings.friction_coefficient;
  const bool flip = settings.transfer.flip;
  // Momentum balance on the grid; the stresses' impulses are in the momenta, but for FLIP.
  for_each_block(state.grid, [&](std::size_t block) {
    velocities_from_sums(body, flip ? 0.0 : friction, flip ? none : pull, block, state);
    if (flip) add_impulses(body, friction, state.grid.forces, flip, pull, block, state);
  });
  push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
  if (should_sort(state)) sort_points(settings, state);
  look_into_wall_cells(state);
  // Grid to points, stress, motion, points to grid.
  return pass_over_points<whole_pass>(body.mix, law, settings, {dt, state.next_dt}, state);
}

/// Updates the stress first (USF), the paper's order: with the points' velocities as the grid has them before
/// the forces act.
template <class Geometry, class Law>
PassSums stress_first(Body<Geometry>& body, const Law& law, const ExplicitSettings& settings,
                      const RigidWall<Geometry::dim>& wall, double dt, ExplicitState<Geometry>& state) {
  const Vec<Geometry::dim> pull = dt * body.gravity, none = Vec<Geometry::dim>::Zero();
  for_each_block(state.grid, [&](std::size_t block) { velocities_from_sums(body, 0.0, none, block, state); });
  if (should_sort(state)) sort_points(settings, state);
  look_into_wall_cells(state);
  PassSums sums = pass_over_points<stress_pass>(body.mix, law, settings, {dt, dt}, state);
  const auto add_from = [&](const auto& of_tiles) {
    for_each_block(state.grid, [&](std::size_t block) {
      add_impulses(body, settings.friction_coefficient, of_tiles, settings.transfer.flip, pull, block, state);
    });
  };
  state.grid.single ? add_from(state.grid.single_sums) : add_from(state.grid.sums);
  push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
  sums.add(pass_over_points<motion_pass>(body.mix, law, settings, {dt, 0.0}, state));
  return sums;
}

/// The step to come, with what is known of the last.
template <class Geometry, class Law>
ExplicitReport begin_step(const Body<Geometry>& body, const Law& law, const ExplicitSettings& settings,
                          ExplicitState<Geometry>& state) {
  ExplicitReport report;
  report.dt = state.next_dt;
  report.limits = state.limits;
  report.beyond_limit = report.dt > state.limits.viscous || report.dt > state.limits.acoustic;
  choose_next_step(body, law, settings, state);
  return report;
}

template <class Geometry>
void end_step(const ExplicitSettings& settings, const PassSums& sums, Body<Geometry>& body,
              ExplicitState<Geometry>& state, ExplicitReport& report) {
  body.time += report.dt;
  body.dt = report.dt;
  report.max_speed = state.max_speed = std::sqrt(sums.speed2);
  report.shear_rate_mean = sums.volume > 0.0 ? sums.volume_rate / sums.volume : 0.0;
  state.lambda_max = sums.lambda;
  state.drift += sums.farthest;
  state.holding.drift += sums.farthest;
  state.wall_drift += sums.farthest * body.grid.axes[0].h + settings.wall_speed * report.dt;
  report.failed = sums.ran_away || !(state.drift < 1.0);
}

}  // namespace detail

template <class Geometry>
ExplicitReport explicit_step(Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
                             ExplicitState<Geometry>& state, const RigidWall<Geometry::dim>& wall) {
  ExplicitReport report = detail::begin_step(body, law, settings, state);
  const auto step = settings.stress == StressUpdate::last ? detail::stress_last<Geometry, YieldLaw>
                                                          : detail::stress_first<Geometry, YieldLaw>;
  detail::end_step(settings, step(body, law, settings, wall, report.dt, state), body, state, report);
  return report;
}

#define TREMIE_EXPLICIT_STEPS_IN(Geometry)                                                                   \
  template ExplicitState<Geometry> start_explicit(Body<Geometry>&, const YieldLaw&, const ExplicitSettings&, \
                                                  const Shape<Geometry::dim>&);                              \
  template ExplicitReport explicit_step(Body<Geometry>&, const YieldLaw&, const ExplicitSettings&,           \
                                        ExplicitState<Geometry>&, const RigidWall<Geometry::dim>&);
TREMIE_EXPLICIT_STEPS_IN(Axisymmetric)
TREMIE_EXPLICIT_STEPS_IN(PlaneStrain)
TREMIE_EXPLICIT_STEPS_IN(ThreeD)

}  // namespace tremie
