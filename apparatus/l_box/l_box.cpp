#include "apparatus/l_box/l_box.hpp"

#include "apparatus/engine.hpp"
#include "libmpm/points/seed.hpp"

namespace tremie::l_box {
namespace {

constexpr double reading_length = 0.02;  // over which the depths are averaged [m]
constexpr double drops = 0.005;          // share of the points that may fall off the column's walls
constexpr double share_of_time = 0.01;   // largest step, in the time since the start of the lift
constexpr double longest_step = 0.3;     // [s]: in longer ones thin films run away

/// Coordinates: x from the back of the column, y from the floor; the gate stands at x = column_length.
Body<PlaneStrain> filled_column(const Scene& scene) {
  const Box& box = scene.box;
  Body<PlaneStrain> body;
  body.mix = scene.mix;
  body.gravity = {0.0, -engine::gravity};
  const auto [across, up] = scene.model.cell;
  const int n_cells =
      std::max(1, static_cast<int>(std::lround((box.column_length + box.channel_length) / across)));
  const double h = (box.column_length + box.channel_length) / n_cells;
  body.grid.axes[0] = {.h = h, .low = FaceKind::no_slip, .high = FaceKind::no_slip, .n_cells = n_cells};
  body.grid.axes[1] = {.h = up, .low = FaceKind::no_slip};
  const auto [n_across, n_up] = scene.model.points_per_cell;
  const std::array<int, 2> n = {std::max(1, static_cast<int>(std::lround(box.column_length / h * n_across))),
                                std::max(1, static_cast<int>(std::lround(box.column_height / up * n_up)))};
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {box.column_length, box.column_height}, n, scene.mix.density, scene.mix.K,
      [](const Vec<2>&) { return true; },
      [&](const Vec<2>& x) { return scene.mix.density * engine::gravity * (box.column_height - x[1]); },
      body.points);
  engine::rest(body, scene.rest);
  return body;
}

/// The column's front wall above the channel, to which the concrete sticks, and what is left of the gate
/// below it, along which it slips; points half a cell apart.
std::vector<BoundaryPoint<2>> front_wall(const Scene& scene, double time) {
  const Box& box = scene.box;
  const double spacing = 0.5 * scene.model.cell[1];
  const double gate = scene.gate_speed ? *scene.gate_speed * time : box.channel_height;
  std::vector<BoundaryPoint<2>> points;
  const int n = static_cast<int>(std::ceil(box.column_height / spacing));
  for (int i = 0; i < n; ++i) {
    const double y = (i + 0.5) * spacing;
    const bool wall = y > box.channel_height;
    if (!wall && y < gate) continue;
    BoundaryPoint<2> point;
    point.x = {box.column_length, y};
    if (!wall) point.normal = {1.0, 0.0};
    points.push_back(point);
  }
  return points;
}

/// Depth of the concrete over [low, high], as a ruler meets its surface: rows of height `row` are counted
/// from the floor up to the first that is less than half full. What clings to a wall or falls higher up is no
/// depth, and below the surface a row is full, however the points are spread in it.
double depth(const Points<2>& points, double low, double high, double row) {
  std::vector<double> fill(2, 0.0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points.x[p][0] < low || points.x[p][0] >= high) continue;
    const std::size_t j = static_cast<std::size_t>(std::max(0.0, points.x[p][1]) / row);
    if (j + 2 > fill.size()) fill.resize(j + 2, 0.0);
    fill[j] += points.volume(p) / ((high - low) * row);
  }
  std::size_t top = 0;
  while (fill[top + 1] >= 0.5) ++top;
  return row * (static_cast<double>(top) + std::min(1.0, fill[top]) + fill[top + 1]);
}

/// Distance of the front from the gate: of the outermost point that has company (three others less than half
/// a cell behind).
double front_of(const Points<2>& points, double gate, double cell) {
  std::vector<double> x;
  for (const auto& p : points.x) x.push_back(p[0]);
  std::sort(x.begin(), x.end(), std::greater<>());
  std::size_t i = 0;
  while (i + 3 < x.size() && x[i] - x[i + 3] > 0.5 * cell) ++i;
  return std::max(0.0, x[i] - gate);
}

/// Depth over [low, high] that the volume below the channel's ceiling has, whatever holes the points leave.
double depth_by_volume(const Points<2>& points, double low, double high, double ceiling) {
  double volume = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.x[p][0] >= low && points.x[p][0] < high && points.x[p][1] < ceiling)
      volume += points.volume(p);
  return volume / (high - low);
}

Sample read(const Body<PlaneStrain>& body, const Scene& scene, const StepReport& step) {
  const Box& box = scene.box;
  const double end = box.column_length + box.channel_length;
  Sample s;
  s.time = body.time;
  s.front = front_of(body.points, box.column_length, body.grid.axes[0].h);
  const double row = body.grid.axes[1].h;
  s.h1 = depth(body.points, box.column_length - reading_length, box.column_length, row);
  if (s.front > box.channel_length - 0.5 * reading_length)
    s.h2 = depth(body.points, end - reading_length, end, row);
  s.max_speed = step.max_speed;
  s.shear_rate_mean = step.shear_rate_mean;
  s.flocculation_mean = engine::mean_flocculation(body.points);
  s.volume_change = engine::volume_change(body.points);
  s.time_step = step.dt;
  s.iterations = step.iterations;
  return s;
}

/// When the front passed a distance from the gate.
std::optional<double> time_of_front(const std::vector<Sample>& series, double distance) {
  for (std::size_t i = 1; i < series.size(); ++i) {
    const Sample &a = series[i - 1], &b = series[i];
    if (b.front < distance) continue;
    return a.time + (distance - a.front) / (b.front - a.front) * (b.time - a.time);
  }
  return std::nullopt;
}

void read_results(const Body<PlaneStrain>& body, const Scene& scene, std::optional<double> stopped_at,
                  Outcome& outcome) {
  const Sample &first = outcome.series.front(), &last = outcome.series.back();
  Results& r = outcome.results;
  r.h1 = last.h1;
  r.h2 = last.h2;
  if (last.h2 && last.h1 > 0.0) r.passing_ratio = *last.h2 / last.h1;
  r.t200 = time_of_front(outcome.series, 0.2);
  r.t400 = time_of_front(outcome.series, 0.4);
  r.stopped_at = stopped_at;
  r.flocculation_mean_start = first.flocculation_mean;
  r.flocculation_mean_end = last.flocculation_mean;
  const Box& box = scene.box;
  const double step = 2.0 * body.grid.axes[0].h;
  r.volume_in_channel = 0.0;
  for (double x = 0.0; x < box.channel_length - 0.5 * step; x += step) {
    const double low = box.column_length + x, high = low + step;
    r.profile.push_back({x + 0.5 * step, depth(body.points, low, high, body.grid.axes[1].h)});
    const double h = depth_by_volume(body.points, low, high, box.channel_height);
    r.profile_by_volume.push_back({x + 0.5 * step, h});
    r.volume_in_channel += h * step;
  }
}

template <class Law>
Outcome run_plane(const Scene& scene, const Law& law, const Observer& observer) {
  Body<PlaneStrain> body = filled_column(scene);
  StepSettings settings = engine::step_settings(scene.model);
  if (!scene.model.time_step) settings.strays = drops;
  settings.fitted_places = true;   // what hangs on the column's walls is thinner than a cell
  settings.moving_surface = true;  // without it steps of tenths of a second carry a fluid past its level
  settings.alternating_viscosity = scene.alternating_viscosity;
  if (scene.model.space == SpaceKind::plane_with_side_walls) settings.side_wall_distance = scene.box.width;
  const double start_mass = engine::total_mass(body.points);

  Outcome outcome;
  outcome.series.push_back(read(body, scene, {}));
  if (observer.on_frame) observer.on_frame(engine::frame_of(body));
  engine::RestWatch watch;
  bool stopped = false;
  double next_frame = scene.frame_interval;
  while (!stopped && body.time < scene.duration * (1.0 - 1e-12)) {
    // The films on the column's walls drain ever more slowly: so may the steps go.
    const double longest = std::clamp(share_of_time * body.time, StepSettings{}.dt_max, longest_step);
    settings.dt_max = std::min(scene.model.step_scale * longest, scene.duration - body.time);
    body.boundary = front_wall(scene, body.time);
    const StepReport step = implicit_step(body, law, settings);
    engine::count_step(body, step, outcome.checks, outcome.cost);
    engine::watch_fixed_step(body, scene.model, step, outcome.checks);
    if (engine::gave_up(step, outcome.status, outcome.checks, body.time)) break;
    outcome.series.push_back(read(body, scene, step));
    if (observer.on_step) observer.on_step(outcome.series.back());
    if (observer.on_frame && body.time >= next_frame) {
      observer.on_frame(engine::frame_of(body));
      next_frame += scene.frame_interval;
    }
    const bool open = !scene.gate_speed || *scene.gate_speed * body.time > scene.box.channel_height;
    // Drops from the films on the column's walls fall long after the concrete stands.
    stopped = watch.at_rest(open, step.bulk_speed, body.time);
    if (observer.interrupted && *observer.interrupted) {
      outcome.status = Status::interrupted;
      break;
    }
  }
  read_results(body, scene, stopped ? watch.slow_since : std::nullopt, outcome);
  engine::judge(body, start_mass, outcome.checks, outcome.cost);
  outcome.final_frame = engine::frame_of(body);
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  return outcome;
}

void refuse_what_has_no_engine(const Scene& scene) {
  if (scene.model.space != SpaceKind::plane && scene.model.space != SpaceKind::plane_with_side_walls)
    throw std::invalid_argument(
        "model.space: the L-box runs in \"plane\" or \"plane_with_side_walls\" for now");
  if (scene.bars != 0)
    throw std::invalid_argument("test.bars: bars need three dimensions, which the L-box has not yet");
  engine::refuse_what_has_no_engine(scene.model, "L-box");
}

}  // namespace

Outcome run(const Scene& scene, const Observer& observer) {
  refuse_what_has_no_engine(scene);
  omp_set_num_threads(scene.threads);
  return engine::with_law(scene.model, [&](const auto& law) { return run_plane(scene, law, observer); });
}

Estimate estimate(const Scene& scene) {
  refuse_what_has_no_engine(scene);
  Body<PlaneStrain> body = filled_column(scene);
  activate(body.grid, body.points);
  Estimate e;
  e.points = static_cast<std::int64_t>(body.points.size());
  e.cells_active = body.grid.n_cells();
  e.bytes_per_point = bytes_per_point<2>(body.points.thixotropic());
  const StepSettings settings = engine::step_settings(scene.model);
  const double collapse = std::sqrt(engine::gravity * scene.box.column_height) /
                          (settings.cfl * std::min(scene.model.cell[0], scene.model.cell[1]));
  e.steps = scene.model.time_step ? std::llround(scene.duration / *scene.model.time_step)
                                  : std::llround(0.5 * collapse + scene.duration / settings.dt_max);
  return e;
}

std::string passing_class(double ratio, int bars) {
  if (ratio < 0.80 || bars == 0) return "";
  return bars == 2 ? "PL1" : "PL2";
}

}  // namespace tremie::l_box
