// An explicit step of the material point method, from top to bottom.

#include "libmpm/explicit/step.hpp"

#include "libmpm/explicit/impulses.hpp"
#include "libmpm/explicit/nodes.hpp"
#include "libmpm/explicit/pass.hpp"
#include "libmpm/explicit/wall_fill.hpp"

namespace tremie {

namespace detail {

template <class Real, class Geometry>
void sort_points(const ExplicitSettings& settings, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  lay_tiles<Real, D>(state.grid,
                     sort_into_tiles<D>(state.grid.axes, state.shape.stencil_shift(), state.points),
                     settings.transfer.flip);
  state.drift = 0.0;
  state.wall_drift = state.holding.drift = 1e300;
  ++state.sorts;
}

/// The limits of the step to come, and its length.
template <class Geometry>
void choose_next_step(const Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
                      ExplicitState<Geometry>& state) {
  double h = state.grid.axes[0].h;
  for (const Axis& a : state.grid.axes) h = std::min(h, a.h);
  const double tau_y = static_yield_stress(state.lambda_max, body.mix.tau_0);
  state.limits = stability_limits(body.mix, law, tau_y, largest_eigenvalues(state.shape.kind), h);
  state.next_dt = settings.fixed_dt.value_or(
      std::min({settings.dt_max, settings.safety * state.limits.together,
                state.max_speed > 0.0 ? settings.cfl * h / state.max_speed : settings.dt_max}));
}

/// use(Real{}) with the precision of shape functions, sums and the law.
template <class Use>
auto in_precision(const ExplicitSettings& settings, Use use) {
  return settings.single_precision ? use(float{}) : use(double{});
}

/// update(block) for each block of nodes: it writes velocities that only the block has.
template <int D, class Update>
void for_each_block(const TileGrid<D>& grid, Update update) {
  const std::size_t n = grid.blocks.size();
#pragma omp parallel for schedule(static)
  for (std::size_t b = 0; b < n; ++b) update(b);
}

/// Sorts the points where they have drifted, and looks into the cells at walls.
template <class Real, class Geometry>
void follow_points(const ExplicitSettings& settings, ExplicitState<Geometry>& state) {
  if (state.drift > drift_allowed(settings)) sort_points<Real>(settings, state);
  look_into_wall_cells(state);
}

/// Updates the stress last (USL): the velocities at the end of a step deform and move the points. Points to
/// grid for the step to come happens in the same pass, with the impulses that the new stresses give in it.
template <class Real, class Geometry>
PassSums stress_last(Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
                     const RigidWall<Geometry::dim>& wall, double dt, ExplicitState<Geometry>& state) {
  using Buffers = typename TileGrid<Geometry::dim>::template Buffers<Real>;
  const Vec<Geometry::dim> pull = dt * body.gravity, none = Vec<Geometry::dim>::Zero();
  const bool flip = settings.transfer.flip;
  const Buffers &sums = std::get<Buffers>(state.grid.sums),
                &impulses = std::get<Buffers>(state.grid.impulses);
  // Momentum balance on the grid with flat walls; the stresses' impulses are in the momenta, but for FLIP.
  for_each_block(state.grid, [&](std::size_t block) {
    velocities_from_sums(body, flip ? nullptr : &settings.wall_law, sums, flip ? none : pull, block, state);
    if (flip) add_impulses(body, &settings.wall_law, impulses, flip, pull, block, state);
  });
  push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
  follow_points<Real>(settings, state);
  // Grid to points, stress, motion, points to grid.
  return pass_over_points<whole_pass, Real>(body.mix, law, settings, {dt, state.next_dt}, state);
}

/// Updates the stress first (USF), the paper's order: with the points' velocities as the grid has them before
/// the forces act.
template <class Real, class Geometry>
PassSums stress_first(Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
                      const RigidWall<Geometry::dim>& wall, double dt, ExplicitState<Geometry>& state) {
  using Buffers = typename TileGrid<Geometry::dim>::template Buffers<Real>;
  const Vec<Geometry::dim> pull = dt * body.gravity, none = Vec<Geometry::dim>::Zero();
  const Buffers& sums = std::get<Buffers>(state.grid.sums);
  for_each_block(state.grid,
                 [&](std::size_t block) { velocities_from_sums(body, nullptr, sums, none, block, state); });
  follow_points<Real>(settings, state);
  // Grid to points, stress, its impulses to the grid.
  PassSums all = pass_over_points<stress_pass, Real>(body.mix, law, settings, {dt, dt}, state);
  // Momentum balance on the grid, flat walls.
  for_each_block(state.grid, [&](std::size_t block) {
    add_impulses(body, &settings.wall_law, sums, settings.transfer.flip, pull, block, state);
  });
  push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
  // Grid to points, motion, points to grid.
  all.add(pass_over_points<motion_pass, Real>(body.mix, law, settings, {dt, 0.0}, state));
  return all;
}

/// The step to come, with what is known of the last.
template <class Geometry>
ExplicitReport begin_step(const Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
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
  report.max_speed = state.max_speed = std::sqrt(largest(sums.speed2));
  const double volume = sum(sums.volume), farthest = largest(sums.farthest);
  report.shear_rate_mean = volume > 0.0 ? sum(sums.volume_rate) / volume : 0.0;
  state.lambda_max = largest(sums.lambda);
  state.drift += farthest;
  state.holding.drift += farthest;
  state.wall_drift += farthest * body.grid.axes[0].h + settings.wall_speed * report.dt;
  report.failed = any(sums.ran_away) || !(state.drift < 1.0);
}

}  // namespace detail

template <class Geometry>
ExplicitState<Geometry> start_explicit(Body<Geometry>& body, const YieldLaw& law,
                                       const ExplicitSettings& settings, const Shape<Geometry::dim>& shape) {
  ExplicitState<Geometry> state;
  state.shape = shape;
  state.grid.axes = body.grid.axes;
  for (double lambda : body.points.lambda) state.lambda_max = std::max(state.lambda_max, lambda);
  take_points<Geometry::dim>(body.points, !settings.transfer.flip, settings.keep_shear_rates, state.points);
  detail::choose_next_step(body, law, settings, state);
  const detail::PassInput input{.impulse_dt = state.next_dt};
  detail::in_precision(settings, [&]<class Real>(Real) {
    detail::sort_points<Real>(settings, state);
    look_into_wall_cells(state);
    settings.stress == StressUpdate::last
        ? detail::pass_over_points<detail::first_sums, Real>(body.mix, law, settings, input, state)
        : detail::pass_over_points<detail::first_momenta, Real>(body.mix, law, settings, input, state);
  });
  if (!settings.keep_affine)
    for (std::vector<f64x8>& C : state.points.C) release(C);
  return state;
}

template <class Geometry>
ExplicitReport explicit_step(Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
                             ExplicitState<Geometry>& state, const RigidWall<Geometry::dim>& wall) {
  ExplicitReport report = detail::begin_step(body, law, settings, state);
  const detail::PassSums sums = detail::in_precision(settings, [&]<class Real>(Real) {
    return settings.stress == StressUpdate::last
               ? detail::stress_last<Real>(body, law, settings, wall, report.dt, state)
               : detail::stress_first<Real>(body, law, settings, wall, report.dt, state);
  });
  detail::end_step(settings, sums, body, state, report);
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
