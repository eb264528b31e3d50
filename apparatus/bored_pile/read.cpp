// What is read off the concrete in the pile.

#include <limits>

#include "apparatus/bored_pile/pour.hpp"
#include "apparatus/parts/pipe_flow.hpp"
#include "apparatus/run/body_readings.hpp"
#include "libmpm/geometry/spaces.hpp"
#include "libmpm/implicit/step_size.hpp"

namespace tremie::bored_pile {
namespace {

/// Volume fractions of the cells, column by column from the axis and from the foot up.
template <class Section>
std::vector<std::vector<double>> fills(const Pour<Section>& pour) {
  const auto& axes = pour.body.grid.axes;
  std::vector<std::vector<double>> fill(static_cast<std::size_t>(axes[0].n_cells));
  const auto& points = pour.body.points;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto c = detail::cell_of<2>(axes, points.x[p]);
    auto& column = fill[static_cast<std::size_t>(c[0])];
    const auto k = static_cast<std::size_t>(c[1]);
    if (column.size() <= k) column.resize(k + 1, 0.0);
    column[k] +=
        points.volume(p) / (Section::measure({(c[0] + 0.5) * axes[0].h, 0.0}) * axes[0].h * axes[1].h);
  }
  return fill;
}

/// Height of the surface of a column [m]: what its highest cells hold, on those below. A few together, because points are not
/// spread so evenly that each cell is full.
double level_of(const std::vector<double>& fill, double h) {
  constexpr std::size_t surface = 5;
  std::size_t k = fill.size();
  while (k > 0 && fill[k - 1] < 0.5) --k;
  double level = static_cast<double>(k = k > surface ? k - surface : 0);
  for (; k < fill.size(); ++k) level += fill[k];
  return level * h;
}

struct Levels {
  double pipe = 0.0, middle = 0.0, wall = 0.0, volume = 0.0;  ///< [m]; volume under the surface [m^3]
  double inside = 0.0, outside = 0.0;                         ///< means about the cage [m]
};

template <class Section>
Levels levels(const Scene& scene, const Pour<Section>& pour) {
  const auto fill = fills(pour);
  const double h = pour.body.grid.axes[0].h, h_up = pour.body.grid.axes[1].h, r = pipe_radius(pour);
  const auto first = static_cast<std::size_t>(pour.inlet.cells);
  const auto at = [&](std::size_t c) { return pour.body.grid.axes[1].origin + level_of(fill[c], h_up); };
  Levels levels{at(first), at((first + fill.size()) / 2), at(fill.size() - 1),
                area_within(scene, r) * mouth_of(pour) - waiting(scene, pour)};
  double area_inside = 0.0, area_outside = 0.0;
  for (std::size_t c = first; c < fill.size(); ++c) {
    const double x = (static_cast<double>(c) + 0.5) * h, area = whole(scene) * h * Section::measure({x, 0.0}),
                 under = at(c) * area;
    levels.volume += under;
    if (!scene.cage) continue;
    (x < scene.cage->radius ? levels.inside : levels.outside) += under;
    (x < scene.cage->radius ? area_inside : area_outside) += area;
  }
  if (scene.cage) levels.inside /= area_inside, levels.outside /= area_outside;
  return levels;
}

/// Mean height of the surface beside the pipe [m].
template <class Section>
double surface_of(const Scene& scene, const Pour<Section>& pour, const Levels& levels) {
  return (levels.volume + waiting(scene, pour) - area_within(scene, pipe_radius(pour)) * mouth_of(pour)) /
         section_of(scene, pour);
}

/// Mean of a number of the points that are chosen, by volume; empty where none is.
template <class Section, class Chosen, class Number>
std::optional<double> mean_over(const Pour<Section>& pour, Chosen chosen, Number number) {
  const auto& points = pour.body.points;
  double sum = 0.0, volume = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (chosen(points.x[p])) sum += points.volume(p) * number(p), volume += points.volume(p);
  return volume > 0.0 ? std::optional(sum / volume) : std::nullopt;
}

template <class Section>
double own_pressure(const Pour<Section>& pour, std::size_t p) {
  return pressure(pour.body.points.ln_J[p], pour.body.mix.K);
}

/// Pressure at the pipe's mouth [Pa], by two layers of cells below it: without_stripes() says why.
template <class Section>
double pressure_at_mouth(const Scene& scene, const Pour<Section>& pour) {
  const double mouth = mouth_of(pour), h = pour.body.grid.axes[1].h,
               weight = pour.body.mix.density * pour.body.gravity[1];
  const auto own = mean_over(
      pour,
      [&](const Vec<2>& x) { return x[0] < pipe_radius(pour) && x[1] < mouth && x[1] > mouth - 2.0 * h; },
      [&](std::size_t p) { return own_pressure(pour, p) + weight * (mouth - pour.body.points.x[p][1]); });
  return std::max(0.0, own.value_or(0.0)) + fluid_pressure(scene, mouth);
}

/// Height of concrete in the pipe above its mouth that the flow needs [m]. All of it is of the load that leaves the mouth.
template <class Section>
double head_needed(const Scene& scene, const Pour<Section>& pour, double at_mouth) {
  const Mix& mix = mix_of(scene, load_at(scene, pour.placed));
  const double tau_y =
      static_yield_stress(mix.thixotropy ? flocculation_at_mouth(scene, pour) : 0.0, mix.tau_0);
  const double left =
      mix.density * gravity - pipe_pressure_gradient(whole(scene) * pour.inlet.flow, scene.pipe.inner_radius,
                                                     scene.model.law, mix.mu, tau_y);
  return left > 0.0 ? at_mouth / left : std::numeric_limits<double>::infinity();
}

/// Largest static yield stress of the points within a cell of the surface [Pa].
template <class Section>
double stress_of_surface(const Pour<Section>& pour, double surface) {
  const double from = surface - pour.body.grid.axes[1].h;
  const auto& points = pour.body.points;
  double largest = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.x[p][1] > from)
      largest = std::max(largest, static_yield_stress(points.thixotropic() ? points.lambda[p] : 0.0,
                                                      pour.body.mix_of(p).tau_0));
  return largest;
}

/// The concrete along the wall, cell by cell from the foot up.
template <class Section>
std::vector<AtWall> along_wall(const Scene& scene, const Pour<Section>& pour) {
  const auto& axes = pour.body.grid.axes;
  const auto& points = pour.body.points;
  const auto foot = static_cast<std::size_t>(pour.foot.layers);
  std::vector<AtWall> wall(pour.wall_max.size() - foot);
  std::vector<double> volume(wall.size(), 0.0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto c = detail::cell_of<2>(axes, points.x[p]);
    const auto k = static_cast<std::size_t>(c[1]);
    if (c[0] != axes[0].n_cells - 1 || k >= wall.size()) continue;
    const double V = points.volume(p);
    volume[k] += V;
    wall[k].pressure_end += V * (own_pressure(pour, p) + fluid_pressure(scene, points.x[p][1]));
    if (points.thixotropic()) wall[k].flocculation += V * points.lambda[p];
    wall[k].age += V * (pour.body.time - pour.batched[p]);
  }
  const double level = mean_level(scene, pour);
  std::size_t n = 0;
  for (; n < wall.size() && volume[n] > 0.0; ++n) {
    AtWall& at = wall[n];
    at.pressure_end /= volume[n], at.flocculation /= volume[n], at.age /= volume[n];
    at.height = axes[1].origin + (static_cast<double>(n) + 0.5) * axes[1].h;
    at.hydrostatic = fluid_pressure(scene, at.height) -
                     scene.mix.density * pour.body.gravity[1] * std::max(0.0, level - at.height);
  }
  wall.resize(n);
  std::vector<double> pressure;
  for (const AtWall& at : wall) pressure.push_back(at.pressure_end);
  pressure = without_stripes(pressure);
  for (std::size_t k = 0; k < n; ++k) {
    wall[k].pressure_end = pressure[k];
    wall[k].pressure_max = pour.wall_max[k + foot];
  }
  return wall;
}

/// Volume mean of lambda, the foot's too; empty without thixotropy.
template <class Section>
std::optional<double> mean_flocculation(const Pour<Section>& pour) {
  const auto &points = pour.body.points, &foot = pour.foot.points;
  const auto mean = experiment::mean_flocculation(points);
  if (!mean || foot.size() == 0) return mean;
  const double V = experiment::total_volume(points), below = experiment::total_volume(foot);
  return (V * *mean + below * *experiment::mean_flocculation(foot)) / (V + below);
}

/// sum V / sum V0 - 1, the foot's too.
template <class Section>
double volume_change(const Pour<Section>& pour) {
  const auto &points = pour.body.points, &foot = pour.foot.points;
  const double change = experiment::volume_change(points);
  if (foot.size() == 0) return change;
  const double V = experiment::total_volume(points), below = experiment::total_volume(foot);
  return (V + below) / (V / (1.0 + change) + below / (1.0 + experiment::volume_change(foot))) - 1.0;
}

}  // namespace

std::vector<double> without_stripes(const std::vector<double>& of_cells) {
  const std::size_t n = of_cells.size();
  if (n < 3) return of_cells;
  const auto at_end = [&](std::size_t a, std::size_t b, std::size_t c) {
    return 0.75 * of_cells[a] + 0.5 * of_cells[b] - 0.25 * of_cells[c];
  };
  std::vector<double> smooth(n);
  smooth[0] = at_end(0, 1, 2), smooth[n - 1] = at_end(n - 1, n - 2, n - 3);
  for (std::size_t k = 1; k + 1 < n; ++k)
    smooth[k] = 0.25 * of_cells[k - 1] + 0.5 * of_cells[k] + 0.25 * of_cells[k + 1];
  return smooth;
}

template <class Section>
Sample read(const Scene& scene, const StepReport& step, Pour<Section>& pour) {
  const auto& body = pour.body;
  const Levels level = levels(scene, pour);
  // What moves to other cells brings velocities that change volume. The step takes that back by an impulse, a blow of pressure in
  // a short step, so pressures are means over a response time, as a pressure cell reads them.
  constexpr double response = 1.0;  // [s]
  const auto follow = [share = -std::expm1(-step.dt / response)](double& mean, double now) {
    mean = mean > 0.0 ? mean + share * (now - mean) : now;
  };
  const std::vector<AtWall> wall = along_wall(scene, pour);
  pour.wall_mean.resize(pour.wall_max.size(), 0.0);
  for (std::size_t k = 0, at = static_cast<std::size_t>(pour.foot.layers); k < wall.size(); ++k, ++at) {
    follow(pour.wall_mean[at], wall[k].pressure_end);
    pour.wall_max[at] = std::max(pour.wall_max[at], pour.wall_mean[at]);
  }
  follow(pour.mouth_mean, pressure_at_mouth(scene, pour));
  Sample now{.time = body.time, .time_step = step.dt, .volume = pour.placed};
  now.level = mean_level(scene, pour);
  if (scene.cage) now.level_step = level.inside - level.outside;
  now.level_pipe = level.pipe, now.level_middle = level.middle, now.level_wall = level.wall;
  now.mouth = mouth_of(pour), now.pressure_mouth = pour.mouth_mean;
  if (pour.inlet.flow > 0.0) now.head = head_needed(scene, pour, now.pressure_mouth);
  now.load = static_cast<double>(load_at(scene, pour.placed) + 1);
  now.surface_stress = stress_of_surface(pour, surface_of(scene, pour, level));
  now.max_speed = step.max_speed, now.shear_rate_mean = step.shear_rate_mean;
  now.flocculation_mean = mean_flocculation(pour);
  now.volume_change = volume_change(pour);
  now.iterations = step.iterations;
  constexpr double lasts = 5.0;  // [s]
  const bool suffices = !now.head || *now.head <= scene.depth + scene.pipe.above - now.mouth;
  pour.short_for = suffices ? 0.0 : pour.short_for + step.dt;
  pour.stopped = pour.short_for > lasts || (now.head && std::isinf(*now.head));
  return now;
}

template <class Section>
void read_results(const Scene& scene, const Pour<Section>& pour, const std::vector<Sample>& series,
                  Results& r) {
  const auto& points = pour.body.points;
  const double level = mean_level(scene, pour);
  r.level_end = level, r.placed = pour.placed;
  const Levels under = levels(scene, pour);
  const double surface = surface_of(scene, pour, under);
  r.volume_error = under.volume / (pour.placed - waiting(scene, pour)) - 1.0;
  double head = 0.0, step = 0.0, placing = 0.0;
  for (const Sample& s : series) {
    head = std::max(head, s.head.value_or(0.0));
    if (s.level_step && s.head) step += s.time_step * *s.level_step, placing += s.time_step;
    r.washed = r.washed || s.level - s.mouth < 0.9 * pour.body.grid.axes[1].h;
  }
  if (placing > 0.0) r.level_step = step / placing;
  if (std::isfinite(head)) r.head_needed = head;
  r.head_suffices = !pour.stopped;
  if (pour.stopped) r.stopped_at = level;
  r.cover.assign(scene.loads.size(), 0.0);
  double top = 0.0, cover = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double V = points.volume(p);
    if (points.x[p][1] > surface - 1.0) top += V, r.plug_share += pour.load[p] == 1.0 ? V : 0.0;
    if (points.x[p][0] > scene.radius - cover_depth(scene))
      cover += V, r.cover[static_cast<std::size_t>(pour.load[p]) - 1] += V;
    if (points.x[p][1] > surface - pour.body.grid.axes[1].h)
      r.oldest_at_surface = std::max(r.oldest_at_surface, pour.body.time - pour.batched[p]);
  }
  r.plug_share /= top;
  for (double& share : r.cover) share /= cover;
  r.wall = along_wall(scene, pour);
  for (std::size_t k = 0; k < r.wall.size() && k < pour.wall_mean.size(); ++k) {
    r.wall[k].pressure_end = pour.wall_mean[k];
    r.pressure_max = std::max(r.pressure_max, r.wall[k].pressure_max);
  }
}

#define TREMIE_READ_POUR_IN(Section)                                     \
  template Sample read(const Scene&, const StepReport&, Pour<Section>&); \
  template void read_results(const Scene&, const Pour<Section>&, const std::vector<Sample>&, Results&);
TREMIE_IN_SECTIONS(TREMIE_READ_POUR_IN)

}  // namespace tremie::bored_pile
