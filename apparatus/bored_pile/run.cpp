// The pour from the first charge to the last load.

#include <fmt/format.h>
#include <omp.h>

#include "apparatus/bored_pile/pour.hpp"
#include "apparatus/run/experiment.hpp"
#include "libmpm/implicit/archived_state.hpp"
#include "libmpm/implicit/steady/standstill.hpp"

namespace tremie::bored_pile {
namespace {

constexpr double longest_step = 2.0;  ///< while nothing flows [s]

/// In long pours points crowd where the velocity's divergence vanishes in the mean of a cell alone: with a tenth of this, 3.3 % of
/// the volume for 1.8 %, before even_layers() (docs/theory/bored_pile.md).
constexpr double alternating_viscosity = 1000.0;

StepSettings step_settings(const Scene& scene) {
  StepSettings settings = experiment::step_settings(scene.model);
  settings.moving_surface = true;
  settings.particle_shifting.rigid_share = 0.1;  // the concrete rises as a plug for thousands of steps
  settings.alternating_viscosity = alternating_viscosity;
  settings.wall_law = scene.walls;
  if (scene.model.space == SpaceKind::plane_with_side_walls) settings.side_wall_distance = scene.width;
  // Newton's method would leave the pressure of stiff concrete where it was.
  if (settings.method == YieldMethod::automatic) settings.method = YieldMethod::admm;
  settings.time_error = 0.002 * scene.model.step_scale * scene.model.step_scale;
  settings.dt_longest = longest_step * scene.model.step_scale;
  return settings;
}

/// By their points' weight columns of cells that hold some per cent more would sink, and the others rise, metres high. In a pause
/// what the solver leaves of velocities must not carry points far, either (docs/theory/bored_pile.md, Weight and Rest).
void settle_in_pauses(bool pauses, StepSettings& settings) {
  constexpr double resting_tolerance = 1e-4;
  settings.admm.tolerance = pauses ? resting_tolerance : StepSettings{}.admm.tolerance;
  settings.weight = pauses ? WeightRule::balanced : WeightRule::balanced_inside;
  settings.cut_cell_rule = pauses;
}

/// A step of the pour. In a pause the concrete comes to rest, and then stands until the next load is placed.
template <class Section>
StepReport advance(const Scene& scene, const StepSettings& settings, Pour<Section>& pour) {
  constexpr double yields = 1e-3;  // share of the yield stress
  if (stands(pour)) {
    const double dt = settings.fixed_dt.value_or(std::min(settings.time_left, settings.dt_longest));
    const StepReport rest = stand_still(dt, pour.body);
    keep_foot(scene, rest, pour);
    return rest;
  }
  const StepReport step = implicit_step(pour.body, scene.model.law, settings);
  if (step.failed) return step;
  keep_foot(scene, step, pour);
  if (!pour.pauses) let_in(scene, pour);
  const bool still = pour.pauses && is_below_yield(pour.body, scene.model.law, yields);
  pour.still_for = still ? pour.still_for + step.dt : 0.0;
  return step;
}

template <class Section>
Frame frame_of(const Pour<Section>& pour) {
  Frame frame = experiment::frame_of(pour.body);
  const Points<2>& foot = pour.foot.points;
  for (std::size_t p = 0; p < foot.size(); ++p) {
    frame.position.push_back(experiment::in_space<Section>(foot.x[p]));
    frame.velocity.push_back({0.0, 0.0, 0.0});
    frame.volume.push_back(foot.volume(p));
    frame.pressure.push_back(pressure(foot.ln_J[p], pour.body.mix.K));
    frame.shear_rate.push_back(0.0);
  }
  const auto append = [](const std::vector<double>& from, std::vector<double>& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(foot.lambda, frame.flocculation);
  frame.load = pour.load;
  append(pour.foot_load, frame.load);
  for (const auto* times : {&pour.batched, &pour.foot_batched})
    for (const double batched : *times) frame.age.push_back(pour.body.time - batched);
  return frame;
}

template <class Section>
void archive_foot(Archive& archive, Pour<Section>& pour) {
  archive(pour.foot, pour.foot_load, pour.foot_batched, pour.foot_level, pour.resting, pour.resting_for);
  if (archive.reads()) stand_on(pour.foot, pour.body);
}

template <class Section>
Record run_section(const Scene& scene, const scene::Observer& observer) {
  Pour<Section> pour = start_of<Section>(scene);
  auto& body = pour.body;
  StepSettings settings = step_settings(scene);
  Record record;
  const double duration = pour.phases.back().end;
  record.series.push_back(read(scene, StepReport{}, pour));
  if (observer.on_frame && observer.all_frames && !goes_on(observer.checkpoints))
    observer.on_frame(frame_of(pour));
  const experiment::Flow flow{
      .time = [&] { return body.time; },
      .unfinished =
          [&] {
            return !pour.stopped && experiment::has_time_left(body.time, duration) &&
                   mean_level(scene, pour) < scene.depth * (1.0 - 1e-9);
          },
      .prepare =
          [&] {
            settings.time_left = prepare(scene, settings.cfl * scene.model.step_scale, pour);
            settings.fixed_dt = experiment::fixed_step(scene.model, settings.time_left);
            settle_in_pauses(pour.pauses, settings);
          },
      .advance =
          [&](Checks& checks, Cost& cost) {
            const StepReport step = advance(scene, settings, pour);
            experiment::count_step(body, step, checks, cost);
            experiment::watch_fixed_step(body, scene.model, step, checks);
            return step;
          },
      .frame = [&] { return frame_of(pour); },
      .tell = [&](bool, Checks&, Cost&) { take_foot_back(pour); },
      .state =
          [&](Archive& archive) {
            archive(body, pour.load, pour.batched, pour.inlet.face, pour.placed, pour.short_for,
                    pour.still_for, pour.wall_mean, pour.wall_max, pour.mouth_mean, record.series);
            for (Inlet::Column& column : pour.inlet.columns) archive(column.waiting);
            archive_foot(archive, pour);
          }};
  experiment::run_experiment(
      flow, body,
      {duration, scene.frame_interval,
       [](const Sample& s) { return fmt::format("level {:.2f} m", s.level); }},
      observer, [&](const StepReport& step) { return read(scene, step, pour); },
      [&](std::optional<double>) {
        read_results(scene, pour, record.series, record.results);
        const double in_points = pour.placed - waiting(scene, pour);
        record.checks.mass_error =
            whole(scene) * experiment::total_mass(body.points) / (scene.mix.density * in_points) - 1.0;
      },
      record);
  return record;
}

template <class Section>
scene::SizeEstimate estimate_section(const Scene& scene) {
  const Pour<Section> pour = start_of<Section>(scene);
  const auto& axes = pour.body.grid.axes;
  scene::SizeEstimate e;
  e.cells_active = experiment::whole_steps(axes[0].n_cells * scene.depth / axes[1].h);
  const Inlet::Column& column = pour.inlet.columns.back();
  e.points = experiment::whole_steps(pile_volume(scene) / whole(scene) / (column.area * pour.inlet.row));
  e.bytes_per_point = bytes_per_point<2>(lambda_numbers(scene.mix));
  const double step = StepSettings{}.cfl * axes[1].h / (scene.rate / whole(scene) * pour.inlet.node_speed);
  e.time_expected = pour_time(scene);
  e.steps = e.steps_expected =
      experiment::whole_steps(scene.model.time_step ? e.time_expected / *scene.model.time_step
                                                    : 1.5 * pile_volume(scene) / scene.rate / step);
  // Of the points at the end: half are there in the mean, and the foot (keep_foot()) is left out.
  const double above = std::min(1.0, (scene.pipe.most + scene.radius) / scene.depth);
  // Shares of side walls take several times the iterations.
  const double walls = scene.model.space == SpaceKind::plane_with_side_walls ? 4.0 : 1.0;
  e.point_step = 0.4e-6 * walls * above * (2.0 - above);
  return e;
}

}  // namespace

Record run(const Scene& scene, const scene::Observer& observer) {
  experiment::refuse_what_has_no_engine(scene.model, "bored pile");
  omp_set_num_threads(scene.threads);
  return scene.width > 0.0 ? run_section<PlaneStrain>(scene, observer)
                           : run_section<Axisymmetric>(scene, observer);
}

scene::SizeEstimate estimate(const Scene& scene) {
  experiment::refuse_what_has_no_engine(scene.model, "bored pile");
  return scene.width > 0.0 ? estimate_section<PlaneStrain>(scene) : estimate_section<Axisymmetric>(scene);
}

}  // namespace tremie::bored_pile
