// The lifted cone by implicit steps.

#include <stdexcept>

#include "apparatus/parts/cone/checks.hpp"
#include "apparatus/parts/cone/series.hpp"
#include "apparatus/parts/cone/set_up.hpp"
#include "apparatus/run/energy_watch.hpp"
#include "libmpm/implicit/archived_state.hpp"

namespace tremie::cone {
namespace {

/// In three dimensions a body that flows is solved with less exact stresses, four thousandths instead of one:
/// half of the cost, and a spread that differs by less than half a millimetre (docs/archive/three_d.md). One that creeps
/// is not, or what they leave would keep it from coming to rest.
constexpr double flowing_tolerance = 4e-3, creeping = 1e-3;  // [1], [m/s]

/// Share of the points that may lie alone before the front of a film that creeps: a long step carries none of them away.
constexpr double detached_share = 0.005;

/// Slower than this, and wider than Scene::film_spread, a section spreads as a film, on flat cells [m/s].
constexpr double film_speed = 5e-3;

/// What a flow has left to gain, as a share of its spread, when points are no longer shifted: in a creep of hours that would
/// push them out of the front of a film, along the floor.
constexpr double little_left = 0.01;

/// A step of the creep at the end, as a share of the time that went before: what is left to flow goes like a power of it.
constexpr double longest_creep_step = 0.05;

/// Puts a section's body on cells of another height; what is kept by cells and nodes is forgotten with them.
template <class Geometry>
void change_cell_height(double h, ImplicitBody<Geometry>& body) {
  if (Geometry::dim == 3 || body.grid.axes[Geometry::up].h == h) return;
  body.grid.axes[Geometry::up].h = h;
  body.grid.cell_map = {};
  body.wall_nodes.clear();
}

template <class Geometry>
Outcome run_implicit_in(const Scene& scene, const scene::Observer& observer) {
  constexpr int D = Geometry::dim;
  ImplicitBody<Geometry> body{filled_cone<Geometry>(scene)};
  if constexpr (D == 3) add_ring(scene, body);
  StepSettings settings = step_settings(scene);
  RigidWall<D> wall;
  if (scene.lift_speed) lifted_wall(scene, settings.wall_gap + settings.cfl * scene.model.cell[0], wall);

  const double longest = settings.dt_max, time_error = settings.time_error;
  Outcome outcome;
  experiment::EnergyWatch energy(experiment::energy_of<Geometry>(body.points, body.mix.K));
  bool flows = true, is_film = false, near_rest = false, cone_gone = false;
  const experiment::Flow flow{
      .time = [&] { return body.time; },
      .unfinished = [&] { return experiment::has_time_left(body.time, scene.duration); },
      .prepare =
          [&] {
            const double left = scene.duration - body.time;
            // The second half of a halved step is as long as the first but for rounding, and is not halved again.
            settings.time_left = experiment::without_sliver(left, body.dt);
            settings.fixed_dt = experiment::fixed_step(scene.model, left);
            settings.dt_longest = longest_creep_step * body.time;
            settings.detached = flows ? 0.0 : detached_share;
            settings.particle_shifting.on = scene.model.particle_shifting && !near_rest;
            settings.dt_max = std::min(longest, longest_step_beside_the_cone(scene, body.time));
            if constexpr (D == 3)
              settings.admm.tolerance = flows ? flowing_tolerance : StepSettings{}.admm.tolerance;
            cone_gone = cone_is_gone(scene, body.time, outcome.series.back());
            if (is_film) {
              change_cell_height(scene.film_cell, body);
              const double before = std::min(scene.model.cell[0], scene.model.cell[1]);
              settings.time_error = time_error * before / body.grid.cell_size_min();  // as long a way
            }
          },
      .advance =
          [&](Checks& checks, Cost& cost) {
            const StepReport step =
                implicit_step(body, scene.model.law, settings, cone_gone ? RigidWall<D>{} : wall);
            flows = step.bulk_speed > creeping;
            near_rest = body.time > first_look * free_fall_time(scene) &&
                        gain_left(scene, outcome.series, outcome.series.back().time) < little_left;
            is_film = is_film || (step.bulk_speed < film_speed && (cone_gone || !scene.lift_speed) &&
                                  outcome.series.back().spread > scene.film_spread);
            experiment::count_step(body, step, checks, cost);
            experiment::watch_fixed_step(body, scene.model, step, checks);
            return step;
          },
      .frame = [&] { return experiment::frame_of(body); },
      .free_to_flow = [&] { return clear_of_the_cone(scene, outcome.series.back()); },
      .stands_since = [&] { return rests_since(scene, outcome.series); },
      .gains_energy =
          [&] {
            // What is elastic in it a body may turn into motion later: it counts for what it may have, not
            // for what it has.
            const bool pushed = wall && !cone_gone;
            energy.see(pushed ? experiment::energy_of<Geometry>(body.points, body.mix.K)
                              : experiment::energy_of_motion<Geometry>(body.points),
                       pushed);
            return energy.ran_away();
          },
      .tell = [&](bool, Checks& checks, Cost&) { energy.tell(checks); },
      .state =
          [&](Archive& archive) {
            archive(body, energy, flows, is_film, near_rest, outcome.series, outcome.results.through_the_cone,
                    outcome.results.height_scale);
          }};
  experiment::run_experiment(
      flow, body, showing(scene), observer,
      [&](const StepReport& step) { return next_line(scene, body, step, outcome); },
      [&](std::optional<double> stopped_at) {
        read_results(scene, stopped_at, outcome);
        if constexpr (D == 3)
          if (scene.ring) outcome.results.step = step_at_the_ring(scene, body.points);
        add_reasons(scene, outcome);
      },
      outcome);
  return outcome;
}

}  // namespace

Outcome run_implicit(const Scene& scene, const scene::Observer& observer) {
  if (scene.model.space == SpaceKind::axisymmetric) return run_implicit_in<Axisymmetric>(scene, observer);
#ifdef TREMIE_SECTIONS_ONLY
  throw std::invalid_argument(
      "model.space: the page has \"axisymmetric\" alone; run the scene by `tremie run`");
#else
  return run_implicit_in<ThreeD>(scene, observer);
#endif
}

}  // namespace tremie::cone
