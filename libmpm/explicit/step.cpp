// An explicit step of the material point method, from top to bottom, and some that follow each other.

#include "libmpm/explicit/step.hpp"

#include "libmpm/explicit/impulses.hpp"
#include "libmpm/explicit/nodes.hpp"
#include "libmpm/explicit/single_precision.hpp"
#include "libmpm/explicit/wall_fill.hpp"

namespace tremie {

namespace detail {

/// A pass over the points for repeat_passes: `of_block(block)` makes the velocities that it reads.
template <Pass pass, class Geometry, class Law, class OfBlock>
auto controls_to_points(bool controls_done, OfBlock of_block, PointsPass<pass, Geometry, Law>& of_tile) {
  return GridPass{controls_done, [of_block](int block, int) { of_block(static_cast<std::size_t>(block)); },
                  [&of_tile](int tile, int step) { of_tile(tile, step); }};
}

/// A pass over the points, with the velocities that the nodes have.
template <Pass pass, class Geometry, class Law>
PassSums pass_over_points(const Mix& mix, const Law& law, const ExplicitSettings& settings,
                          const PassInput& input, ExplicitState<Geometry>& state) {
  const auto no_change = [](std::size_t) {};
  PointsPass<pass, Geometry, Law> of_tile{mix, law, settings, input, state};
  run_passes(state.grid, controls_to_points(true, no_change, of_tile));
  return of_tile.sums(0);
}

}  // namespace detail

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

/// Updates the stress last (USL): the velocities at the end of a step deform and move the points. Points to
/// grid for the step to come happens in the same pass, with the impulses that the new stresses give in it.
/// Returns the sums of each of n steps: one where there is a wall, or the points must be sorted.
template <class Geometry, class Law>
std::vector<detail::PassSums> stress_last(Body<Geometry>& body, const Law& law,
                                          const ExplicitSettings& settings,
                                          const RigidWall<Geometry::dim>& wall, double dt, int n,
                                          ExplicitState<Geometry>& state) {
  const Vec<Geometry::dim> pull = dt * body.gravity, none = Vec<Geometry::dim>::Zero();
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
  detail::PointsPass<detail::whole_pass, Geometry, Law> whole{body.mix, law, settings, {dt, state.next_dt},
                                                              state,    n};
  repeat_passes(state.grid, n, detail::controls_to_points(all_at_once, velocities, whole));
  std::vector<detail::PassSums> sums;
  for (int step = 0; step < n; ++step) sums.push_back(whole.sums(step));
  return sums;
}

/// Updates the stress first (USF), the paper's order: with the points' velocities as the grid has them before
/// the forces act. Sums and n as in stress_last.
template <class Geometry, class Law>
std::vector<detail::PassSums> stress_first(Body<Geometry>& body, const Law& law,
                                           const ExplicitSettings& settings,
                                           const RigidWall<Geometry::dim>& wall, double dt, int n,
                                           ExplicitState<Geometry>& state) {
  const Vec<Geometry::dim> pull = dt * body.gravity, none = Vec<Geometry::dim>::Zero();
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
  detail::PointsPass<detail::stress_pass, Geometry, Law> stress{body.mix, law, settings, {dt, dt}, state, n};
  detail::PointsPass<detail::motion_pass, Geometry, Law> motion{body.mix, law, settings, {dt, 0.0}, state, n};
  const auto first = detail::controls_to_points(sort, velocities, stress);
  const auto second = detail::controls_to_points(bool{wall}, impulses, motion);
  if (wall) {
    run_passes(state.grid, first);
    for_each_block(state.grid, impulses);
    detail::push_off_wall(wall, body.time + dt, dt, settings.wall_gap, state);
    run_passes(state.grid, second);
  } else {
    repeat_passes(state.grid, n, first, second);
  }
  std::vector<detail::PassSums> sums;
  for (int step = 0; step < n; ++step) {
    sums.push_back(stress.sums(step));
    sums.back().add(motion.sums(step));
  }
  return sums;
}

namespace detail {

/// How many steps may follow each other, at most `most`, before points must be sorted or cells at walls
/// looked into, if they move no more than twice as far in each as in the last. Points that are faster all of
/// a sudden are sorted late, and those that leave what their tile sees fail.
template <class Geometry>
int steps_in_a_row(const ExplicitSettings& settings, const ExplicitState<Geometry>& state, bool wall,
                   std::int64_t most) {
  if (wall || settings.fixed_dt != state.next_dt || should_sort(state) || state.holding.drift >= hold_drift)
    return 1;
  const double left = std::min(drift_allowed - state.drift, hold_drift - state.holding.drift);
  const double steps = left / std::max(2.0 * state.farthest, 1e-300);
  return static_cast<int>(
      std::clamp(static_cast<double>(std::min<std::int64_t>(most, TileGrid<Geometry::dim>::most_times)), 1.0,
                 std::max(1.0, steps)));
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
  state.farthest = sums.farthest;
  state.drift += sums.farthest;
  state.holding.drift += sums.farthest;
  state.wall_drift += sums.farthest * body.grid.axes[0].h + settings.wall_speed * report.dt;
  report.failed = sums.ran_away || !(state.drift < 1.0);
}

}  // namespace detail

template <class Geometry>
std::vector<ExplicitReport> explicit_steps(Body<Geometry>& body, const YieldLaw& law,
                                           const ExplicitSettings& settings, std::int64_t most,
                                           ExplicitState<Geometry>& state,
                                           const RigidWall<Geometry::dim>& wall) {
  const int n = detail::steps_in_a_row(settings, state, bool{wall}, most);
  std::vector<ExplicitReport> reports{detail::begin_step(body, law, settings, state)};
  const double dt = reports[0].dt;
  const auto sums = settings.stress == StressUpdate::last
                        ? stress_last(body, law, settings, wall, dt, n, state)
                        : stress_first(body, law, settings, wall, dt, n, state);
  for (const detail::PassSums& of_step : sums) {
    if (&of_step != sums.data()) reports.push_back(detail::begin_step(body, law, settings, state));
    detail::end_step(settings, of_step, body, state, reports.back());
    if (reports.back().failed) break;
  }
  return reports;
}

template ExplicitState<Axisymmetric> start_explicit(Body<Axisymmetric>&, const YieldLaw&,
                                                    const ExplicitSettings&, const Shape<2>&);
template std::vector<ExplicitReport> explicit_steps(Body<Axisymmetric>&, const YieldLaw&,
                                                    const ExplicitSettings&, std::int64_t,
                                                    ExplicitState<Axisymmetric>&, const RigidWall<2>&);
template ExplicitState<PlaneStrain> start_explicit(Body<PlaneStrain>&, const YieldLaw&,
                                                   const ExplicitSettings&, const Shape<2>&);
template std::vector<ExplicitReport> explicit_steps(Body<PlaneStrain>&, const YieldLaw&,
                                                    const ExplicitSettings&, std::int64_t,
                                                    ExplicitState<PlaneStrain>&, const RigidWall<2>&);
template ExplicitState<ThreeD> start_explicit(Body<ThreeD>&, const YieldLaw&, const ExplicitSettings&,
                                              const Shape<3>&);
template std::vector<ExplicitReport> explicit_steps(Body<ThreeD>&, const YieldLaw&, const ExplicitSettings&,
                                                    std::int64_t, ExplicitState<ThreeD>&,
                                                    const RigidWall<3>&);

}  // namespace tremie
