// The slump flow by implicit steps.

#include <stdexcept>

#include "apparatus/run/energy_watch.hpp"
#include "apparatus/run/frames.hpp"
#include "apparatus/run/run_checks.hpp"
#include "apparatus/run/run_loop.hpp"
#include "apparatus/slump_flow/checks.hpp"
#include "apparatus/slump_flow/series.hpp"
#include "apparatus/slump_flow/set_up.hpp"
#include "libmpm/implicit/archived_state.hpp"

namespace tremie::slump_flow {
namespace {

/// In three dimensions a body that flows is solved with less exact stresses, four thousandths instead of one:
/// half of the cost, and a spread that differs by less than half a millimetre (docs/archive/three_d.md). One that creeps
/// is not, or what they leave would keep it from coming to rest.
constexpr double flowing_tolerance = 4e-3, creeping = 1e-3;  // [1], [m/s]

template <class Geometry>
Outcome run_implicit_in(const Scene& scene, const Observer& observer) {
  constexpr int D = Geometry::dim;
  ImplicitBody<Geometry> body{filled_cone<Geometry>(scene)};
  StepSettings settings = step_settings(scene);
  const double start_mass = test_run::total_mass(body.points);
  RigidWall<D> wall;
  if (scene.lift_speed) lifted_wall(scene, settings.wall_gap + settings.cfl * scene.model.cell[0], wall);

  const double longest = settings.dt_max;
  Outcome outcome;
  outcome.series.push_back(read(scene, body, {}));
  if (observer.on_frame && !goes_on(observer.checkpoints)) observer.on_frame(test_run::frame_of(body));
  test_run::EnergyWatch energy(test_run::energy_of<Geometry>(body.points, body.mix.K));
  bool flows = true, cone_gone = false;
  const test_run::Flow flow{
      .time = [&] { return body.time; },
      .unfinished = [&] { return body.time < scene.duration * (1.0 - 1e-12); },
      .prepare =
          [&] {
            const double left = scene.duration - body.time;
            settings.time_left = test_run::without_sliver(left, body.dt);
            settings.fixed_dt = test_run::fixed_step(scene.model, left);
            settings.dt_max = std::min(longest, longest_step_beside_the_cone(scene, body.time));
            if constexpr (D == 3)
              settings.admm.tolerance = flows ? flowing_tolerance : StepSettings{}.admm.tolerance;
            cone_gone = cone_is_gone(scene, body.time, outcome.series.back());
          },
      .advance =
          [&](Checks& checks, Cost& cost) {
            const StepReport step =
                implicit_step(body, scene.model.law, settings, cone_gone ? RigidWall<D>{} : wall);
            flows = step.bulk_speed > creeping;
            test_run::count_step(body, step, checks, cost);
            test_run::watch_fixed_step(body, scene.model, step, checks);
            return step;
          },
      .read = [&](const StepReport& step) { record(scene, body, step, observer, outcome); },
      .frame = [&] { return test_run::frame_of(body); },
      .speed = [](const StepReport& step) { return step.max_speed; },
      .free_to_flow = [&] { return clear_of_the_cone(scene, outcome.series.back()); },
      .stands_since = [&] { return stands_since(scene, outcome.series); },
      .gains_energy =
          [&] {
            // What is elastic in it a body may turn into motion later: it counts for what it may have, not
            // for what it has.
            const bool pushed = wall && !cone_gone;
            energy.see(pushed ? test_run::energy_of<Geometry>(body.points, body.mix.K)
                              : test_run::energy_of_motion<Geometry>(body.points),
                       pushed);
            return energy.ran_away();
          },
      .state =
          [&](Archive& archive) {
            archive(body, energy, flows, outcome.series, outcome.results.through_the_cone);
          }};
  const auto stopped_at =
      test_run::run_loop(flow,
                         {observer.on_frame, observer.interrupted, scene.frame_interval,
                          test_run::frame_after(0.0, scene.frame_interval), observer.checkpoints},
                         outcome.status, outcome.checks, outcome.cost);

  read_results(stopped_at, outcome);
  energy.tell(outcome.checks);
  test_run::judge(body, start_mass, outcome.checks, outcome.cost);
  test_run::judge_volume(outcome.series.front().volume_change, outcome.checks);
  judge_depth(scene, outcome);
  judge_cells(scene, outcome);
  judge_points_across(scene, outcome);
  judge_lift(outcome);
  judge_lift_speed(scene, outcome);
  judge_opening(scene, outcome);
  judge_height(scene, outcome);
  outcome.final_frame = test_run::frame_of(body);
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  return outcome;
}

}  // namespace

Outcome run_implicit(const Scene& scene, const Observer& observer) {
  if (scene.model.space == SpaceKind::axisymmetric) return run_implicit_in<Axisymmetric>(scene, observer);
#ifdef TREMIE_SECTIONS_ONLY
  throw std::invalid_argument(
      "model.space: the page has \"axisymmetric\" alone; run the scene by `tremie run`");
#else
  return run_implicit_in<ThreeD>(scene, observer);
#endif
}

}  // namespace tremie::slump_flow
