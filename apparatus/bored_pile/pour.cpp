#include "apparatus/bored_pile/pour.hpp"

#include <type_traits>

#include "apparatus/run/body_readings.hpp"
#include "apparatus/run/step_settings.hpp"
#include "libmpm/geometry/spaces.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie::bored_pile {
namespace {

/// The axis from the middle to the wall, of cells of about `cell`: of the numbers of cells within a quarter of that the one of
/// which a face is nearest to the pipe's outside.
Axis across(const Scene& scene) {
  const double wanted = scene.radius / scene.model.cell[0], share = pipe_reach(scene) / scene.radius;
  const auto cost = [&](int n) {
    const double faces = std::max(1.0, std::round(n * share));
    return std::abs(n * share / faces - 1.0) + 0.1 * std::abs(n - wanted) / wanted;
  };
  int best = std::max(2, static_cast<int>(std::lround(wanted)));
  for (int n = std::max(2, static_cast<int>(wanted / 1.25)); n <= 1.25 * wanted + 1.0; ++n)
    if (cost(n) < cost(best)) best = n;
  return {.h = scene.radius / best, .low = FaceKind::free_slip, .high = face(scene.walls), .n_cells = best};
}

/// Gives the points, which are the first load's, and those to come the mix of their load; what scales a step's tolerances is the
/// mean of the loads.
template <class Section>
void tell_mixes_apart(const Scene& scene, ImplicitBody<Section>& body) {
  body.mixes = scene.mixes;
  body.points.mix.assign(body.points.size(), 0);
  double volume = 0.0, tau_0 = 0.0, mu = 0.0;
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    const double V = scene.loads[i].volume;
    volume += V, tau_0 += V * scene.mixes[i].tau_0, mu += V * scene.mixes[i].mu;
  }
  body.mix.tau_0 = tau_0 / volume, body.mix.mu = mu / volume;
}

/// Adds a point of the concrete that leaves the pipe.
template <class Section>
void add_concrete(const Scene& scene, Pour<Section>& pour, const Vec<2>& x, double V, double speed) {
  auto& points = pour.body.points;
  const Mix& mix = scene.mix;
  const double under = std::max(0.0, mean_level(scene, pour) - x[1]);
  const double ln_J = ln_J_under((mix.density - scene.fluid_density) * gravity * under, mix.K);
  add_point<2>(points, x, mix.density * V, V * std::exp(-ln_J), ln_J);
  points.v.back()[1] = -speed;
  const std::size_t load = load_at(scene, pour.placed);
  if (!scene.mixes.empty()) points.mix.push_back(static_cast<int>(load));
  pour.load.push_back(static_cast<double>(load + 1));
  pour.batched.push_back(pour.body.time - scene.loads[load].age);
  if (!mix.thixotropy) return;
  const double lambda = flocculation_at_mouth(scene, pour);
  points.lambda.push_back(lambda), points.gamma_dot.push_back(0.0);
  const auto shares = part_shares(mix.thixotropy->kinetics);
  for (std::size_t i = 0; i < points.lambda_parts.size(); ++i)
    points.lambda_parts[i].push_back(shares[i] * lambda);
}

/// The stretches of pause and pour, load by load; what stands in the pile at the start is taken off the first.
std::vector<Phase> phases_of(const Scene& scene, double first_charge) {
  std::vector<Phase> phases;
  double time = 0.0, placed = first_charge, done = 0.0;
  for (const Load& load : scene.loads) {
    done += load.volume;
    if (placed > first_charge && load.pause > 0.0) phases.push_back({time, time += load.pause, 0.0, placed});
    if (done <= placed) continue;
    phases.push_back({time, time + (done - placed) / scene.rate, scene.rate, placed});
    time = phases.back().end, placed = done;
  }
  return phases;
}

/// Shifts the points upwards or down, layer by layer of cells, so that each layer below the surface holds what it has room for:
/// a share of what is missing or too much in a step. Points crowd on their way through the pile by several per cent, and what
/// evens them out from cell to cell (particle_shifting.hpp) mends little where the concrete rises as a plug.
template <class Section>
void even_layers(Pour<Section>& pour) {
  constexpr double share = 0.1;
  const auto& grid = pour.body.grid;
  const Axis &across = grid.axes[0], &up = grid.axes[1];
  auto& x = pour.body.points.x;
  std::vector<double> volume;
  std::vector<int> top(static_cast<std::size_t>(across.n_cells), 0);
  for (std::size_t p = 0; p < x.size(); ++p) {
    const auto c = detail::cell_of<2>(grid.axes, x[p]);
    const auto k = static_cast<std::size_t>(c[1]);
    if (volume.size() <= k) volume.resize(k + 1, 0.0);
    volume[k] += pour.body.points.volume(p);
    int& highest = top[static_cast<std::size_t>(c[0])];
    highest = std::max(highest, c[1]);
  }
  const int layers = *std::min_element(top.begin() + pour.inlet.cells, top.end()) - 1;
  if (layers <= pour.inlet.face) return;
  volume[static_cast<std::size_t>(pour.inlet.face - 1)] += volume_waiting(pour.inlet);
  const double R = across.length(), r = pipe_radius(pour);
  constexpr bool ring = std::is_same_v<Section, Axisymmetric>;
  const double pile = ring ? std::numbers::pi * R * R : R,
               beside = pile - (ring ? std::numbers::pi * std::pow(r, 2) : r);
  std::vector<double> shift{0.0};
  for (int k = 0; k < layers; ++k) {
    const double room = (k < pour.inlet.face ? pile : beside) * up.h;
    shift.push_back(shift.back() + share * up.h * (volume[static_cast<std::size_t>(k)] / room - 1.0));
  }
  for (Vec<2>& at : x) {
    const Vec<2> from = at;
    const double layer = std::min((at[1] - up.origin) / up.h, layers - 1e-9);
    const auto k = static_cast<std::size_t>(layer);
    const double s = layer - static_cast<double>(k);
    at[1] += std::clamp((1.0 - s) * shift[k] + s * shift[k + 1], -0.1 * up.h, 0.1 * up.h);
    keep_in_domain<2>(grid, from, at);
  }
}

/// Pulls the pipe by as many cells as leave it the least embedment.
template <class Section>
void pull(const Scene& scene, Pour<Section>& pour) {
  const Axis& up = pour.body.grid.axes[1];
  const double level = mean_level(scene, pour), embedment = level - mouth_of(pour);
  const Phase& last = pour.phases.back();
  const double to_come = last.before + last.rate * (last.end - last.begin) - pour.placed;
  const double length = std::min(
      {scene.pipe.pull, embedment - scene.pipe.least, to_come / area_within(scene, pipe_radius(pour))});
  const int cells = static_cast<int>(std::floor(length / up.h + 1e-9));
  if (cells < 1) return;
  double stays = 0.0;
  pull_up(pour.inlet, up, cells, [&](const Vec<2>& x, double V, double speed) {
    add_concrete(scene, pour, x, V, speed);
    stays += V;
  });
  pour.placed += whole(scene) * stays;
  pour.body.wall_nodes.clear();
  pour.still_for = 0.0;
}

}  // namespace

std::size_t load_at(const Scene& scene, double volume) {
  std::size_t i = 0;
  for (double end = scene.loads[0].volume; i + 1 < scene.loads.size() && volume >= end * (1.0 - 1e-9);)
    end += scene.loads[++i].volume;
  return i;
}

template <class Section>
double flocculation_at_mouth(const Scene& scene, const Pour<Section>& pour) {
  const std::size_t load = load_at(scene, pour.placed);
  const Mix& mix = mix_of(scene, load);
  const Thixotropy& t = *mix.thixotropy;
  double before = 0.0;
  for (std::size_t i = 0; i < load; ++i) before += scene.loads[i].volume;
  // A pipe's filling stood still in the pause before its load.
  const double r = scene.pipe.inner_radius;
  const double filling = std::numbers::pi * r * r * std::max(0.0, mean_level(scene, pour) - mouth_of(pour));
  const bool stood = before > pour.first_charge && pour.placed < before + filling;
  return flocculation_after_rest(t.initial_flocculation, t, mix.tau_0,
                                 scene.loads[load].rest + (stood ? scene.loads[load].pause : 0.0));
}

template <class Section>
Pour<Section> start_of(const Scene& scene) {
  Pour<Section> pour;
  auto& body = pour.body;
  const auto [n, n_up] = scene.model.points_per_cell;
  body.mix = mix_of(scene, 0);
  body.gravity[1] = -gravity * (1.0 - scene.fluid_density / scene.mix.density);
  body.grid.axes[0] = across(scene);
  const double h = body.grid.axes[0].h, h_up = scene.model.cell[1];
  body.grid.axes[1] = {.h = h_up, .low = FaceKind::no_slip};
  const int cells = std::max(1, static_cast<int>(std::lround(pipe_reach(scene) / h)));
  const int face = std::max(1, static_cast<int>(std::lround(scene.pipe.start / h_up)));
  pour.inlet = make_inlet<Section>(body.grid.axes, cells, face, n * cells, h_up / n_up);
  const double mouth = mouth_of(pour), top = mouth + 2.0 * h_up, r = cells * h;
  pour.placed = pour.first_charge = section_of(scene, pour) * top + area_within(scene, r) * mouth;
  const int rows = (face + 2) * n_up;
  seed_box<Section>(
      {0.0, 0.0}, {scene.radius, top}, {body.grid.axes[0].n_cells * n, rows}, scene.mix.density, scene.mix.K,
      [&](const Vec<2>& x) { return x[0] > r || x[1] < mouth; },
      [&](const Vec<2>& x) { return scene.mix.density * -body.gravity[1] * (top - x[1]); }, body.points);
  experiment::rest(body, scene.loads[0].rest);
  if (!scene.mixes.empty()) tell_mixes_apart(scene, body);
  pour.load.assign(body.points.size(), 1.0);
  pour.batched.assign(body.points.size(), -scene.loads[0].age);
  pour.phases = phases_of(scene, pour.first_charge);
  if (scene.cage) body.bars = screen_of(*scene.cage, scene.depth, h_up);
  pour.wall_max.assign(static_cast<std::size_t>(scene.depth / h_up) + 2, 0.0);
  return pour;
}

template <class Section>
double prepare(const Scene& scene, double cfl, Pour<Section>& pour) {
  if (mean_level(scene, pour) - mouth_of(pour) > scene.pipe.most) pull(scene, pour);
  const double now = pour.body.time;
  const auto after = std::find_if(pour.phases.begin(), pour.phases.end(),
                                  [&](const Phase& p) { return now < p.end * (1.0 - 1e-12); });
  const Phase& phase = after == pour.phases.end() ? pour.phases.back() : *after;
  const double due = phase.before + phase.rate * (now - phase.begin), ahead = pour.placed - due;
  const bool waits =
      ahead > 1e-9 * pour.placed;  // a pulled pipe's concrete is there before the pump has brought it
  pour.inlet.flow = waits ? 0.0 : phase.rate / whole(scene);
  pour.pauses = phase.rate == 0.0;
  if (!pour.pauses) pour.still_for = 0.0;
  place_pipe(pour.inlet, pour.body.grid);
  double left = phase.end - now;
  if (waits && phase.rate > 0.0) left = std::min(left, ahead / phase.rate);
  left = experiment::without_sliver(left, pour.body.dt);
  const double fastest = plug_speed(pour.inlet);
  return fastest > 0.0 ? std::min(left, cfl * pour.body.grid.axes[1].h / fastest) : left;
}

template <class Section>
void let_in(const Scene& scene, Pour<Section>& pour) {
  const double dt = pour.body.dt;
  bend_paths(pour.body.grid, dt, pour.body.points);
  tremie::let_in(pour.inlet, pour.body.grid.axes[1], dt,
                 [&](const Vec<2>& x, double V, double speed) { add_concrete(scene, pour, x, V, speed); });
  pour.placed += whole(scene) * pour.inlet.flow * dt;
  even_layers(pour);
}

template <class Section>
void keep_foot(const Scene& scene, const StepReport& step, Pour<Section>& pour) {
  constexpr int least = 4, apart = 2;  // layers; those next to what flows stay
  constexpr double lasts = 5.0;        // [s]
  auto& body = pour.body;
  const double level = mean_level(scene, pour);
  const double grown = -body.mix.density * body.gravity[1] * (level - pour.foot_level);
  pour.foot_level = level;
  wait(step.dt, grown, body, pour.foot);
  pour.wall_mean.resize(pour.wall_max.size(), 0.0);
  for (std::size_t k = 0; k < static_cast<std::size_t>(pour.foot.layers); ++k) {
    pour.wall_mean[k] += grown;
    pour.wall_max[k] = std::max(pour.wall_max[k], pour.wall_mean[k]);
  }
  const int reach = pour.inlet.face - static_cast<int>(std::ceil(scene.radius / body.grid.axes[1].h));
  if (reach < least || stands(pour)) return;
  const int resting = std::min(resting_layers(body, scene.model.law) - apart, reach);
  pour.resting = pour.resting_for > 0.0 ? std::min(pour.resting, resting) : resting;
  pour.resting_for += step.dt;
  if (pour.resting_for < lasts) return;
  if (pour.resting >= least) {
    const std::vector<char> below = set_aside(pour.resting, body, pour.foot);
    move_chosen(below, pour.load, pour.foot_load);
    move_chosen(below, pour.batched, pour.foot_batched);
    pour.inlet.face -= pour.resting;
    place_pipe(pour.inlet, body.grid);
  }
  pour.resting_for = 0.0;
}

template <class Section>
void take_foot_back(Pour<Section>& pour) {
  pour.inlet.face += pour.foot.layers;
  take_back(pour.body, pour.foot);
  const std::vector<char> all(pour.foot_load.size(), 1);
  move_chosen(all, pour.foot_load, pour.load);
  move_chosen(all, pour.foot_batched, pour.batched);
}

#define TREMIE_POUR_IN(Section)                                             \
  template Pour<Section> start_of(const Scene&);                            \
  template double prepare(const Scene&, double, Pour<Section>&);            \
  template void let_in(const Scene&, Pour<Section>&);                       \
  template void keep_foot(const Scene&, const StepReport&, Pour<Section>&); \
  template void take_foot_back(Pour<Section>&);                             \
  template double flocculation_at_mouth(const Scene&, const Pour<Section>&);
TREMIE_IN_SECTIONS(TREMIE_POUR_IN)

}  // namespace tremie::bored_pile
