#include "apparatus/parts/boxes/boxes.hpp"

#include <fmt/format.h>
#include <omp.h>

#include "apparatus/common/shared_keys.hpp"
#include "apparatus/parts/boxes/set_up.hpp"

namespace tremie::boxes {
namespace {

/// When the run is expected to end at rest [s]: as Mix A does with and without rest, and a plain Bingham concrete, to
/// a factor of two for others. In space a box has stood for the 30 s that count as rest after 70 to 90 s, at 10 to 100 Pa.
double expected_time(const Scene& scene) {
  if (in_space(scene)) return std::min(80.0, scene.duration);
  double lambda = 0.0;
  if (scene.mix.thixotropy)
    lambda = flocculation_after_rest(scene.mix.thixotropy->initial_flocculation, *scene.mix.thixotropy,
                                     scene.mix.tau_0, scene.rest);
  const double tau_y = static_yield_stress(lambda, scene.mix.tau_0);
  const double viscous = (scene.mix.mu + viscosity(scene.model.law, typical_rate, tau_y)) / tau_y;
  const double time = 40.0 + (scene.mix.thixotropy ? 45.0 : 150.0) * viscous;
  return time < scene.duration ? time : scene.duration;
}

template <class Geometry>
void count(const Scene& scene, scene::SizeEstimate& e) {
  const auto [h, h_up] = scene.model.cell;
  const auto [n, n_up] = scene.model.points_per_cell;
  double cells = scene.box.column_length * scene.box.column_height / (h * h_up), in_a_cell = n * n_up;
  if (Geometry::dim == 3) cells *= computed_width(scene) / h, in_a_cell *= n_up;
  experiment::count_points(
      cells, in_a_cell, [&] { return filled_column<Geometry>(scene); }, e);
  if (scene.pour)
    e.cells_active = experiment::whole_steps(scene.pour->volume / scene.box.width / (h * h_up)),
    e.points = experiment::whole_steps(static_cast<double>(e.cells_active) * n * n_up);
  e.bytes_per_point = bytes_per_point<Geometry::dim>(lambda_numbers(scene.mix));
}

template <class Geometry>
scene::SizeEstimate estimate_in(const Scene& scene) {
  scene::SizeEstimate e;
  count<Geometry>(scene, e);
  const StepSettings settings = experiment::step_settings(scene.model);
  constexpr double sinking = 2.0;  // that the column sinks fast [s]
  const double collapse = 0.5 * std::sqrt(experiment::gravity * scene.box.column_height) /
                          (settings.cfl * std::min(scene.model.cell[0], scene.model.cell[1]));
  const auto steps = [&](double share, double time, double dt) {
    return experiment::whole_steps(scene.model.time_step
                                       ? time / *scene.model.time_step
                                       : share * collapse * std::min(1.0, time / sinking) + time / dt);
  };
  e.time_expected = std::min(scene.duration, expected_time(scene) + (scene.pour ? scene.pour->time : 0.0));
  e.point_step = in_space(scene) ? 1.6e-6 : 0.75e-6;
  e.steps = steps(1.0, scene.duration, settings.dt_max);
  e.steps_expected = std::min(e.steps, steps(0.8, e.time_expected, 2.3 * settings.dt_max));
  return e;
}

}  // namespace

bool in_space(const Scene& scene) {
  return scene.model.space == SpaceKind::half || scene.model.space == SpaceKind::full;
}

void check_width(const scene::Values& values, int bars, double bar_diameter) {
  const double least = (3 * bars + 2) * bar_diameter;
  if (bars == 0 || values.number("box.width") >= least) return;
  values.fail("box.width",
              fmt::format("is too narrow for {} bars of {:g} mm; allowed: at least \"{}\"", bars,
                          1e3 * bar_diameter, scene::write_quantity(least, scene::Dimension::length)));
}

double gap_between_bars(const Scene& scene) {
  return (scene.box.width - scene.bars * scene.box.bar_diameter) / (scene.bars + 1);
}

void check_cells(const scene::Values& values, const Scene& scene) {
  const auto [across, up] = scene.model.cell;
  const Box& box = scene.box;
  if (across > box.column_length || up > box.channel_height)
    values.fail("model.cell",
                fmt::format("is larger than the column or the gate; allowed: at most [\"{}\", \"{}\"]",
                            write_quantity(box.column_length, scene::Dimension::length),
                            write_quantity(box.channel_height, scene::Dimension::length)));
  const auto [n_across, n_up] = scene.model.points_per_cell;
  const double section = box.column_length / across * n_across * box.column_height / up * n_up;
  check_points(values, in_space(scene) ? section * box.width / across * n_up : section);
}

std::string front_text(const Sample& now) { return fmt::format("front {:.0f} mm", 1e3 * now.front); }

Outcome run(const Scene& scene, const scene::Observer& observer, ProgressText text) {
  experiment::refuse_what_has_no_engine(scene.model, "box");
  omp_set_num_threads(scene.threads);
  return in_space(scene) ? run_3d(scene, observer, text) : run_plane(scene, observer, text);
}

scene::SizeEstimate estimate(const Scene& scene) {
  experiment::refuse_what_has_no_engine(scene.model, "box");
  return in_space(scene) ? estimate_in<ThreeD>(scene) : estimate_in<PlaneStrain>(scene);
}

}  // namespace tremie::boxes
