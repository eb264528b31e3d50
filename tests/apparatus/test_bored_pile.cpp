// The pour of a bored pile: its volume, its pressure, its loads, what stops it and what is refused.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <any>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "apparatus/bored_pile/pour.hpp"
#include "apparatus/registry/registry.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie {
namespace {

// A short pile on coarse cells, of three loads; the pipe is pulled twice.
constexpr const char* pile = R"(
apparatus = "bored_pile"
[mix]
yield_stress = "50 Pa"
plastic_viscosity = "30 Pa.s"
[pile]
radius = "0.3 m"
depth = "1.2 m"
[pipe]
inner_radius = "75 mm"
outer_radius = "82 mm"
embedment = ["0.2 m", "0.5 m"]
pull = "0.25 m"
start = "0.1 m"
[test]
rate = "8 m3/h"
[[load]]
volume = "0.1 m3"
[[load]]
volume = "0.1 m3"
pause = "30 s"
[[load]]
volume = "0.1 m3"
[model]
cell = "40 mm"
points_per_cell = 3
[output]
frames = false
)";

scene::Outcome run(const std::vector<std::string>& overrides = {}) {
  return scene::run(scene::read_text(pile, "pile.toml", overrides));
}

bored_pile::Scene bored_pile_scene(const std::vector<std::string>& overrides) {
  return std::any_cast<const bored_pile::Scene&>(scene::read_text(pile, "pile.toml", overrides).test);
}

double result(const scene::Outcome& outcome, const char* name) {
  return std::get<double>(*scene::find_result(outcome, name));
}

// Every point that entered is there, and the loads are placed in full; the level is that of the volume beside the pipe. The
// surface is read to a fraction of a cell of 40 mm in a pile of 1.2 m: its volume within 1 % of what was placed. At rest the
// wall bears the weight of concrete and fluid above it (2400 and 1100 kg/m3), which the flow may raise by its yield stress over
// the gap, 2 tau_0 H/(R - r), and its viscosity.
TEST(BoredPile, HoldsWhatWasPlaced) {
  const scene::Outcome outcome = run();
  EXPECT_TRUE(outcome.checks.reasons.empty()) << outcome.checks.reasons.front();
  EXPECT_NEAR(result(outcome, "placed_m3"), 0.3, 1e-9);
  EXPECT_LE(std::abs(result(outcome, "volume_error")), 1e-2);
  const double level = result(outcome, "level_end_m"), g = 9.80665, area = std::numbers::pi * 0.3 * 0.3;
  EXPECT_GT(level, 0.3 / area);
  EXPECT_LT(level, 0.3 / (area - std::numbers::pi * 0.09 * 0.09));
  EXPECT_LE(std::abs(outcome.checks.mass_error), 1e-9);
  const double at_rest = 1100.0 * g * 1.2 + 1300.0 * g * level;
  EXPECT_GT(result(outcome, "wall_pressure_max_Pa"), 0.97 * at_rest);
  EXPECT_LT(result(outcome, "wall_pressure_max_Pa"), at_rest + 2.0 * 50.0 * level / 0.22 + 1000.0);
  double cover = 0.0;
  for (const auto& [name, share] :
       std::get<std::vector<scene::Result>>(*scene::find_result(outcome, "cover")))
    cover += std::get<double>(share);
  EXPECT_NEAR(cover, 1.0, 1e-12);
}

// The pressure at the mouth is that of the fluid and the concrete above it, and what the annulus takes: the head that the pipe
// needs balances it with the pipe's own friction, 2 tau_0/r and more.
TEST(BoredPile, TellsTheHead) {
  const scene::Outcome outcome = run();
  const double head = result(outcome, "head_needed_m");
  const auto* mouth = scene::find_column(outcome.series, "mouth_m");
  EXPECT_GT(head, (1100.0 * (1.2 - mouth->values.front())) / 2400.0);
  EXPECT_LT(head, 2.0);
  EXPECT_TRUE(std::get<bool>(*scene::find_result(outcome, "head_suffices")));
}

// 5000 Pa take 2 tau_0/r = 200 kPa a metre of the pipe, eight times their weight: the pour stops where it stands, which is an
// answer.
TEST(BoredPile, StopsWhereNoHeadSuffices) {
  const scene::Outcome outcome = run({"mix.yield_stress=5 kPa"});
  EXPECT_TRUE(outcome.checks.reasons.empty());
  EXPECT_FALSE(std::get<bool>(*scene::find_result(outcome, "head_suffices")));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(*scene::find_result(outcome, "head_needed_m")));
  EXPECT_LT(result(outcome, "level_end_m"), 0.3);
}

// A concrete without a yield stress fills the pile as well.
TEST(BoredPile, PoursAFluid) {
  const scene::Outcome outcome = run({"mix.yield_stress=0 Pa"});
  EXPECT_TRUE(outcome.checks.reasons.empty()) << outcome.checks.reasons.front();
  EXPECT_LE(std::abs(result(outcome, "volume_error")), 1e-2);
}

// Concrete at the surface rides up unsheared and gains A_thix for as long, the pause of 30 s included: more than 60 Pa at 2 Pa/s.
TEST(BoredPile, SurfaceGainsStrengthInAPause) {
  const scene::Outcome outcome =
      run({"mix.thixotropy.structuration_rate=2 Pa/s", "mix.thixotropy.destructuration=0.1"});
  EXPECT_GT(result(outcome, "static_yield_stress_surface_Pa"), 50.0 + 60.0);
}

// Above a mouth that stays where it is concrete rises beside the pipe as in a long annulus: no ring of it sinks, and none is much
// faster than the mean. A plug of Bingham concrete between walls H = 0.45 m apart at Bi = tau_0 H/(mu U) = 40 is 1.16 times as fast
// as the mean U, by the closed form of a slit. Where columns of cells weighed what their points did, by some per cent too much or
// too little, a jet of ten times the mean stood beside the pipe and the rest sank.
TEST(BoredPile, RisesAsAPlug) {
  constexpr int rings = 6;  // of cells of 75 mm
  constexpr double inner = 0.15, outer = 0.6, rate = 27.0 / 3600.0,
                   mean = rate / (std::numbers::pi * (outer * outer - inner * inner));
  const Frame end =
      bored_pile::run(bored_pile_scene({"mix.yield_stress=20 Pa", "pile.radius=0.6 m", "pile.depth=4 m",
                                        "pipe.inner_radius=125 mm", "pipe.outer_radius=135 mm",
                                        "pipe.above=4 m", "pipe.embedment=[\"0.2 m\", \"5 m\"]",
                                        "test.rate=27 m3/h", "load[0].volume=2 m3", "load[1].volume=1 m3",
                                        "load[1].pause=0 s", "load[2].volume=0.6 m3", "model.cell=75 mm"}))
          .final_frame;
  std::array<double, rings> flow{}, volume{};
  for (std::size_t p = 0; p < end.position.size(); ++p) {
    const double r = end.position[p][0], z = end.position[p][2];
    if (z < 1.0 || z > 2.5 || r < inner) continue;
    const auto ring = std::min<std::size_t>(rings - 1, static_cast<std::size_t>((r - inner) / 0.075));
    flow[ring] += end.volume[p] * end.velocity[p][2], volume[ring] += end.volume[p];
  }
  for (std::size_t ring = 0; ring < rings; ++ring) {
    const double speed = flow[ring] / volume[ring] / mean;
    std::printf("ring %zu: %.2f of the mean speed\n", ring, speed);
    EXPECT_GT(speed, ring == 0 || ring == rings - 1 ? 0.0 : 0.9);
    EXPECT_LT(speed, 1.3);
  }
}

// A table of a list is changed by its index: a longer pause before the second load, and nothing else.
TEST(BoredPile, ALoadIsChangedByItsIndex) {
  const auto before = bored_pile_scene({}), after = bored_pile_scene({"load[1].pause=2 min"});
  EXPECT_EQ(after.loads[1].pause, 120.0);
  EXPECT_EQ(after.loads[2].pause, before.loads[2].pause);
  EXPECT_EQ(after.loads[1].volume, before.loads[1].volume);
}

// Concrete that is older than it is workable is told; so is a mouth that is pulled out of it.
TEST(BoredPile, TellsOldConcreteAndAWashedMouth) {
  EXPECT_FALSE(run({"test.workable=1 min"}).checks.reasons.empty());
  EXPECT_FALSE(run({"pipe.embedment=[\"0 m\", \"0.4 m\"]", "pipe.pull=0.4 m", "model.cell=30 mm"})
                   .checks.reasons.empty());
}

// A cage holds the concrete back, so that it stands higher inside. Bars of a tenth of a millimetre are as good as none: they leave
// the slope of the surface from the pipe to the wall. The level is read to some 5 mm, a fifth of a cell.
TEST(BoredPile, StandsHigherInsideACage) {
  const auto step = [](const char* diameter) {
    return result(
        run({"mix.yield_stress=200 Pa", "cage.radius=0.2 m", "cage.bars=16",
             fmt::format("cage.bar_diameter={}", diameter), "cage.hoop_spacing=0 m", "model.cell=27 mm"}),
        "level_step_mm");
  };
  EXPECT_GT(step("25 mm"), step("0.1 mm") + 5.0);
}

/// Head and pressure at the mouth, row by row while this load is placed and flows.
std::vector<std::array<double, 2>> heads(const scene::Outcome& outcome, double load) {
  const auto of = [&](const char* name) { return scene::find_column(outcome.series, name)->values; };
  const auto loads = of("load"), head = of("head_needed_m"), mouth = of("pressure_at_mouth_Pa");
  std::vector<std::array<double, 2>> rows;
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (loads[i] == load && std::isfinite(head[i])) rows.push_back({head[i], mouth[i]});
  return rows;
}

/// Buckingham and Reiner: the pressure gradient that drives the flow Q through a pipe, by bisection of the plug's share phi.
double buckingham_reiner(double Q, double R, double tau_0, double mu) {
  double low = 1e-6, high = 1.0 - 1e-12;
  for (int i = 0; i < 100; ++i) {
    const double phi = 0.5 * (low + high), G = 2.0 * tau_0 / (phi * R);
    const double flow =
        std::numbers::pi * std::pow(R, 4) * G / (8.0 * mu) * (1.0 - 4.0 / 3.0 * phi + std::pow(phi, 4) / 3.0);
    (flow > Q ? low : high) = phi;
  }
  return 2.0 * tau_0 / (low * R);
}

// A stiffer second load: while it leaves the mouth the head carries the pressure there and its own friction in the pipe, while the
// others do theirs. Both are closed forms, and the head is what was written.
TEST(BoredPile, TheHeadIsThatOfTheLoadInThePipe) {
  const scene::Outcome outcome =
      run({"load[1].yield_stress=200 Pa", "load[1].plastic_viscosity=60 Pa.s", "pipe.above=10 m"});
  EXPECT_TRUE(outcome.checks.reasons.empty()) << outcome.checks.reasons.front();
  EXPECT_LE(std::abs(result(outcome, "volume_error")), 1e-2);
  for (const auto& [load, tau_0, mu] : {std::array{1.0, 50.0, 30.0}, {2.0, 200.0, 60.0}, {3.0, 50.0, 30.0}}) {
    const double G = buckingham_reiner(8.0 / 3600.0, 0.075, tau_0, mu);
    const auto rows = heads(outcome, load);
    EXPECT_GT(rows.size(), 5u) << load;
    for (const auto& [head, mouth] : rows)
      EXPECT_NEAR(head * (2400.0 * gravity - G), mouth, 1e-6 * mouth) << load;
  }
}

// A load that repeats the scene's mix is the same pour. One that differs is told from the others point by point: until it
// enters, nothing differs but by rounding.
TEST(BoredPile, ALoadOfTheSameMixChangesNothing) {
  const auto one = run(), same = run({"load[1].yield_stress=50 Pa", "load[2].plastic_viscosity=30 Pa.s"}),
             other = run({"load[2].yield_stress=150 Pa"});
  const auto& levels = scene::find_column(one.series, "level_at_pipe_m")->values;
  EXPECT_EQ(scene::find_column(same.series, "level_at_pipe_m")->values, levels);
  EXPECT_EQ(heads(same, 3.0), heads(one, 3.0));
  const auto before = heads(one, 2.0), beside = heads(other, 2.0);
  ASSERT_EQ(beside.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR(beside[i][1], before[i][1], 1e-3 * before[i][1]) << i;
  EXPECT_GT(heads(other, 3.0).back()[0], heads(one, 3.0).back()[0]);
}

// Stiffer concrete pushes the first load up before it, weaker concrete breaks through it: the mean height of the first load at the
// end.
TEST(BoredPile, AWeakerLoadOvertakesTheFirst) {
  const auto height_of_first = [](const char* yield_stress) {
    std::vector<std::string> overrides;
    for (const int load : {1, 2})
      overrides.push_back(fmt::format("load[{}].yield_stress={}", load, yield_stress));
    const Frame end = bored_pile::run(bored_pile_scene(overrides)).final_frame;
    double sum = 0.0, volume = 0.0;
    for (std::size_t p = 0; p < end.load.size(); ++p)
      if (end.load[p] == 1.0) sum += end.volume[p] * end.position[p][2], volume += end.volume[p];
    return sum / volume;
  };
  const double weaker = height_of_first("5 Pa"), stiffer = height_of_first("300 Pa");
  std::printf("mean height of the first load: %.3f m under weaker loads, %.3f m under stiffer ones\n", weaker,
              stiffer);
  EXPECT_GT(stiffer, weaker + 0.05);
}

// A panel 1.6 m long and 250 mm wide, half of it as a plane: what was placed is there and is read back within 0.1 %, and the level
// is that of the volume beside a slot of the pipe's area, which is a cell of 42.1 mm here. With walls that slip the concrete at its
// end rests on nothing but its own: the wall bears its weight and the fluid's, the pipe's outside holding up to 2 tau_0 over the
// distance to it.
TEST(BoredPile, PoursAPanel) {
  const std::vector<std::string> panel{
      "model.space=plane",      "pile.radius=0.8 m",      "pile.width=0.25 m",      "load[0].volume=0.15 m3",
      "load[1].volume=0.13 m3", "load[2].volume=0.13 m3", "walls.contact=free_slip"};
  const scene::Outcome outcome = run(panel);
  EXPECT_TRUE(outcome.checks.reasons.empty()) << outcome.checks.reasons.front();
  EXPECT_NEAR(result(outcome, "placed_m3"), 0.41, 1e-9);
  // The surface is read to a twentieth of a cell of 40 mm, over a metre of concrete.
  EXPECT_LE(std::abs(result(outcome, "volume_error")), 2e-3);
  EXPECT_LE(std::abs(outcome.checks.mass_error), 1e-9);
  const double level = result(outcome, "level_end_m"), slot = 0.8 / 19,
               mouth = scene::find_column(outcome.series, "mouth_m")->values.back();
  EXPECT_NEAR(2.0 * 0.25 * (0.8 * level - slot * (level - mouth)), 0.41, 1e-9);
  const double at_rest = 9.80665 * (1100.0 * 1.2 + 1300.0 * level);
  // The pipe's outside bears up to 2 % of it, and one pressure a cell scatters by some tenths with the processor's rounding.
  EXPECT_NEAR(result(outcome, "wall_pressure_max_Pa"), at_rest, 0.03 * at_rest);
}

// Between its long walls the same panel's concrete moves against their drag as well. In the mean over the pour the pressure at the
// mouth is larger by more than what two plates take on the way straight up, (tau_0 + 6 mu U/W) 2/W over the embedment with the mean
// speed U, and by less than what they take on the way to the panel's end besides.
TEST(BoredPile, LongWallsHoldAPanelsConcrete) {
  const auto excess = [](const char* space) {  // over the weight of fluid and concrete, and the embedment
    const scene::Outcome outcome =
        run({fmt::format("model.space={}", space), "pile.radius=0.8 m", "pile.width=0.25 m",
             "load[0].volume=0.15 m3", "load[1].volume=0.13 m3", "load[2].volume=0.13 m3"});
    EXPECT_TRUE(outcome.checks.reasons.empty()) << outcome.checks.reasons.front();
    const auto of = [&](const char* name) { return scene::find_column(outcome.series, name)->values; };
    const auto level = of("level_m"), mouth = of("mouth_m"), pressure = of("pressure_at_mouth_Pa"),
               head = of("head_needed_m");
    double sum = 0.0, embedment = 0.0, n = 0.0;
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (!std::isfinite(head[i])) continue;
      sum += pressure[i] - gravity * (1100.0 * (1.2 - mouth[i]) + 1300.0 * (level[i] - mouth[i]));
      embedment += level[i] - mouth[i], n += 1.0;
    }
    return std::array{sum / n, embedment / n};
  };
  const auto held = excess("plane_with_side_walls"), free = excess("plane");
  const double U = 8.0 / 3600.0 / (1.6 * 0.25), up = 2.0 / 0.25 * (50.0 + 6.0 * 30.0 * U / 0.25) * held[1],
               sideways = 2.0 / 0.25 * 50.0 * 0.8, more = held[0] - free[0];
  std::printf("pressure at the mouth: %.0f Pa more between long walls, %.0f Pa straight up\n", more, up);
  EXPECT_GT(more, up);
  EXPECT_LT(more, up + sideways);
}

/// The frames of a pour from one time to another [s].
std::vector<Frame> frames_between(double from, double to, const std::vector<std::string>& overrides,
                                  bored_pile::Record& record) {
  std::vector<Frame> frames;
  scene::Observer observer;
  observer.on_frame = [&](const Frame& frame) {
    if (frame.time > from && frame.time < to) frames.push_back(frame);
  };
  record = bored_pile::run(bored_pile_scene(overrides), observer);
  EXPECT_EQ(record.checks.unconverged_steps, 0);
  return frames;
}

/// How far the point that moved farthest did [m].
double largest_move(const Frame& from, const Frame& to) {
  double most = 0.0;
  for (std::size_t p = 0; p < from.position.size(); ++p)
    most = std::max(
        most, std::hypot(to.position[p][0] - from.position[p][0], to.position[p][2] - from.position[p][2]));
  return most;
}

// Bingham concrete stops in a finite time, and then bears its weight below its yield stress for good, as structure only builds up.
// In the ten minutes after the first two of a pause no point moves by a millimetre, beside walls that hold and that slip. lambda
// gains A_thix t/tau_0 at every point, as the kinetics' breakdown is zero at rest.
TEST(BoredPile, StandsStillInAPause) {
  for (const char* walls : {"no_slip", "free_slip"}) {
    bored_pile::Record record;
    const auto frames =
        frames_between(20.4 + 120.0, 20.4 + 730.0,
                       {"load[1].pause=740 s", fmt::format("walls.contact={}", walls),
                        "output.frame_interval=10 s", "mix.thixotropy.structuration_rate=0.1 Pa/s"},
                       record);
    ASSERT_GE(frames.size(), 50u);
    const Frame &first = frames.front(), &last = frames.back();
    ASSERT_GE(last.time - first.time, 600.0);
    const double moved = largest_move(first, last), gain = 0.1 * (last.time - first.time) / 50.0;
    std::printf("%s: %.0f s at rest, %.3f mm\n", walls, last.time - first.time, 1e3 * moved);
    EXPECT_LT(moved, 1e-3);
    for (std::size_t p = 0; p < first.flocculation.size(); ++p)
      ASSERT_NEAR(last.flocculation[p] - first.flocculation[p], gain, 1e-3 * gain);
  }
}

// 15 m of concrete of the default K rest for an hour beside walls that slip, as walls that hold carry some of the weight. From the
// third minute on no point moves by a millimetre; volume and level are the same within 0.2 %, and so is the pressure on the lowest
// cells to that of the weight above them.
TEST(BoredPile, AnHourAtRestWithoutDrift) {
  bored_pile::Record record;
  const auto frames = frames_between(
      195.0, 3660.0,
      {"pile.depth=16 m", "pipe.start=14.9 m", "pipe.embedment=[\"0.1 m\", \"2 m\"]", "load[0].volume=4.3 m3",
       "load[1].volume=0.01 m3", "load[1].pause=62 min", "load[2].volume=0.01 m3", "walls.contact=free_slip",
       "model.cell=[\"75 mm\", \"100 mm\"]", "output.frame_interval=100 s"},
      record);
  ASSERT_GE(frames.size(), 30u);
  const Frame &first = frames.front(), &last = frames.back();
  ASSERT_EQ(first.position.size(), last.position.size());
  const double slot = 0.075 * 0.075, level = (4.3 / std::numbers::pi - slot * 14.9) / (0.3 * 0.3 - slot);
  double ratio = 0.0, foot = 0.0, volume[2] = {0.0, 0.0};
  for (std::size_t p = 0; p < last.position.size(); ++p) {
    volume[0] += first.volume[p], volume[1] += last.volume[p];
    if (last.position[p][2] > 0.1) continue;
    const double V = last.volume[p];
    ratio += V * last.pressure[p] / (1300.0 * gravity * (level - last.position[p][2])), foot += V;
  }
  const auto level_at = [&](double time) {
    const auto line = std::find_if(record.series.begin(), record.series.end(),
                                   [time](const bored_pile::Sample& s) { return s.time >= time; });
    return line->level_middle;
  };
  const double moved = largest_move(first, last), sunk = level_at(first.time) - level_at(last.time);
  std::printf("%.0f s at rest: %.3f mm, surface %.3f mm, volume %+.1e, pressure on the base %+.3f %%\n",
              last.time - first.time, 1e3 * moved, -1e3 * sunk, volume[1] / volume[0] - 1.0,
              100.0 * (ratio / foot - 1.0));
  EXPECT_LT(moved, 1e-3);
  EXPECT_NEAR(volume[1] / volume[0], 1.0, 2e-3);
  EXPECT_NEAR(sunk, 0.0, 2e-3 * level);
  EXPECT_NEAR(ratio / foot, 1.0, 2e-3);
}

// A fluid without a yield stress never stands: its surface goes on to level in the pause, and the run takes its steps.
TEST(BoredPile, AFluidDoesNotStand) {
  const auto lines_at_rest = [](const char* yield_stress) {
    const auto record = bored_pile::run(bored_pile_scene(
        {fmt::format("mix.yield_stress={}", yield_stress), "load[0].volume=0.08 m3", "load[1].pause=60 s"}));
    return std::count_if(record.series.begin(), record.series.end(),
                         [](const bored_pile::Sample& s) { return s.max_speed == 0.0; });
  };
  EXPECT_LE(lines_at_rest("0 Pa"), 1);  // the first line
  EXPECT_GT(lines_at_rest("50 Pa"), 10);
}

/// Force over mu U on a metre of one bar of a row in a slice across it, resolved: the bar, on a plane of symmetry, moves at U
/// through concrete that stands still, its surface held by points on cells of an eighth of its diameter.
double resolved_bar(double diameter, double spacing, double Bi) {
  constexpr double mu = 30.0, speed = 1e-4;
  const int across = static_cast<int>(std::lround(4.0 * spacing / diameter)), along = 4 * across;
  const double h = 0.5 * spacing / across;
  ImplicitBody<PlaneStrain> body;
  body.mix.tau_0 = Bi * mu * speed / diameter, body.mix.mu = mu;
  body.mix.density = 1.0;  // creeping flow
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = along};
  body.grid.axes[1] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = across};
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {along * h, across * h}, {2 * along, 2 * across}, 1.0, body.mix.K,
      [](const auto&) { return true; }, [](const auto&) { return 0.0; }, body.points);
  const int n = static_cast<int>(std::ceil(std::numbers::pi * diameter / h));
  for (int k = 0; k < n; ++k) {
    const double angle = std::numbers::pi * (k + 0.5) / n;
    body.boundary.push_back(
        {.x = {0.5 * along * h + 0.5 * diameter * std::cos(angle), 0.5 * diameter * std::sin(angle)},
         .velocity = {speed, 0.0}});
  }
  StepSettings settings;
  settings.fixed_dt = 1.0;
  settings.particle_shifting.on = false;
  settings.admm.tolerance = 1e-4, settings.admm.max_iterations = 20000;
  settings.boundary_stiffness = 1e3 * mu / (h * h);  // a thousand times the viscous one of a cell
  EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  double force = 0.0;
  for (const auto& point : body.bound) force += 2.0 * wall_force<2>(point, body.grid.cell_nodes, body.v)[0];
  return force / (mu * speed);
}

/// The same of the screen that stands for a cage of such bars.
double screened_bar(double diameter, double spacing, double Bi) {
  bored_pile::Cage cage{.radius = 0.65, .bars = 16, .bar_diameter = diameter};
  cage.radius = spacing * cage.bars / (2.0 * std::numbers::pi);
  constexpr double height = 1.0;
  double force = 0.0;
  for (const BarPoint<2>& bar : bored_pile::screen_of(cage, height, 0.05))
    force += bar.length * (bar_yield_drag * Bi + 1.0 / bar.mobility);
  return force / (cage.bars * height);
}

// A slice across a cage: what the screen takes from concrete that flows through it, over what the bars take where cells resolve
// them, is the ratio of the pressure drops. On these cells resolved bars take 3 % too much in a Newtonian fluid, 4, 6 and 15 % at
// Bi = 1, 10 and 100 (tests/verification/bars.md). The screen adds the limit load of a single bar to a Newtonian row, which is
// too little in between: 8 % in a Newtonian fluid and 30 % else are what is asked of it.
TEST(BoredPile, AScreenTakesLessThanItsBars) {
  for (const double spacing : {8.0, 4.0, 3.0})
    for (const double Bi : {0.0, 1.0, 10.0, 100.0}) {
      const double D = 0.032, resolved = resolved_bar(D, D * spacing, Bi),
                   screen = screened_bar(D, D * spacing, Bi);
      std::printf("S/D %g, Bi %g: screen %.1f, resolved %.1f, ratio %.2f\n", spacing, Bi, screen, resolved,
                  screen / resolved);
      EXPECT_GT(screen / resolved, Bi > 0.0 ? 0.7 : 0.92) << spacing << " " << Bi;
      EXPECT_LT(screen / resolved, 1.0) << spacing << " " << Bi;
    }
}

// Alternating pressures, the larger the higher, on a straight line: what is left is the line.
TEST(BoredPile, ReadsPressuresWithoutStripes) {
  std::vector<double> line, stripes;
  for (int k = 0; k < 20; ++k) {
    line.push_back(40e3 - 600.0 * k);
    stripes.push_back(line.back() + (k % 2 == 0 ? 1.0 : -1.0) * 250.0 * k);
  }
  const std::vector<double> smooth = bored_pile::without_stripes(stripes);
  for (std::size_t k = 1; k + 1 < line.size(); ++k) EXPECT_NEAR(smooth[k], line[k], 1e-9) << k;
  EXPECT_EQ(bored_pile::without_stripes(line), line);
}

TEST(BoredPile, RefusesWhatCannotBePoured) {
  for (const char* set : {"pipe.outer_radius=0.3 m", "pipe.inner_radius=90 mm", "pipe.pull=0.4 m",
                          "pipe.embedment=[\"0.5 m\", \"0.2 m\"]", "pipe.start=1.1 m", "test.rate=0 m3/h",
                          "fluid.density=2500 kg/m3", "cage.radius=0.28 m", "model.scheme=explicit",
                          "model.cell=0.2 m", "cage.bars=60", "model.space=plane", "pile.width=0.25 m",
                          "load[3].pause=1 s", "load[x].pause=1 s", "load[].pause=1 s", "pile[0].radius=1 m"})
    EXPECT_THROW(run({set}), scene::InputError) << set;
}

// What a load may not have of its own, with what it lacks beside it.
TEST(BoredPile, RefusesWhatAllLoadsShare) {
  for (const auto& set : std::vector<std::vector<std::string>>{
           {"load[1].density=2300 kg/m3"},
           {"load[1].structuration_rate=1 Pa/s"},
           {"load[1].yield_stress=60 Pa", "model.method=newton"},
           {"load[1].yield_stress=0 Pa", "mix.thixotropy.structuration_rate=1 Pa/s"},
           {"load[1].plastic_viscosity=20 Pa.s", "mix.consistency=12 Pa.s^n", "mix.flow_index=1.2"}})
    EXPECT_THROW(run(set), scene::InputError) << set.front();
}

}  // namespace
}  // namespace tremie
