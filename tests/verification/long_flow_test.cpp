// A flow that goes on for 30,000 steps: Bingham concrete sinks beside a pipe, between two cylinders, with a plug in the middle.
// Points that strayed from their radius would carry structure out of the plug and volume out of their ring.

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "apparatus/run/body_readings.hpp"
#include "libmpm/implicit/step.hpp"
#include "libmpm/particles/seeding.hpp"
#include "libmpm/transfer/apic.hpp"

namespace tremie {
namespace {

constexpr double h = 0.04, inner = 4 * h, outer = 16 * h, tau_0 = 54.0, mu = 35.8,
                 plug = 0.4 * (outer - inner);
constexpr double step = 0.1, duration = 30'000 * step, A_thix = tau_0 / duration;

/// As deep as three cells and periodic, it sinks by a body force of 2 tau_0 over the plug's width. Its points lie off their raster,
/// by up to 0.15 of their distance, so that cells hold more and fewer of them as they pass by.
ImplicitBody<Axisymmetric> between_cylinders() {
  ImplicitBody<Axisymmetric> body;
  body.mix.density = 2400.0, body.mix.tau_0 = tau_0, body.mix.mu = mu, body.mix.K = 350e6;
  body.mix.thixotropy = Thixotropy{A_thix, GatedKinetics{0.0358, 0.1}};
  body.gravity[1] = -2.0 * tau_0 / plug / body.mix.density;
  body.grid.axes[0] = {
      .h = h, .low = FaceKind::free_slip, .high = FaceKind::no_slip, .n_cells = 16, .repeated_knots = {4}};
  body.grid.axes[1] = {.h = h, .periodic = true, .n_cells = 3};
  body.grid.blocks = {{{0, 0}, {4, 3}, [](const Vec<2>&) { return Vec<2>(0.0, 0.0); }}};
  seed_box<Axisymmetric>(
      {inner, 0.0}, {outer, 3 * h}, {24, 6}, body.mix.density, body.mix.K, [](const auto&) { return true; },
      [](const auto&) { return 0.0; }, body.points);
  std::uint32_t seed = 1;
  for (Vec<2>& x : body.points.x)
    for (double& along : x) {
      seed = seed * 1664525u + 1013904223u;
      along += 0.15 * h * (static_cast<double>(seed >> 8) / 16777216.0 - 0.5);
    }
  for (Vec<2>& x : body.points.x) keep_in_domain<2>(body.grid.axes, x);
  experiment::rest(body, 0.0);
  return body;
}

/// Volume of the points from one radius to another, and their mean lambda.
struct Ring {
  double volume = 0.0, lambda = 0.0;
};
Ring ring(const Points<2>& points, double from, double to) {
  Ring of;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.x[p][0] > from && points.x[p][0] < to)
      of.volume += points.volume(p), of.lambda += points.volume(p) * points.lambda[p];
  of.lambda /= of.volume;
  return of;
}

struct LongFlow {
  double in_plug, at_walls;   ///< lambda at the end
  double plug_off, ring_off;  ///< of the volume of the plug's four rings, and of the worst ring, as a share
};

LongFlow flow_long(const ParticleShifting& shifting) {
  omp_set_num_threads(1);
  auto body = between_cylinders();
  StepSettings settings;
  settings.fixed_dt = step;
  settings.alternating_viscosity = 1000.0;
  settings.particle_shifting = shifting;
  const auto ring_at = [&](int c) { return ring(body.points, c * h, (c + 1) * h).volume; };
  std::vector<double> volume;
  for (int c = 4; c < 16; ++c) volume.push_back(ring_at(c));
  int unconverged = 0, steps = 0;
  for (; body.time < duration - 0.5 * step; ++steps)
    unconverged += implicit_step(body, ExactBingham{}, settings).converged ? 0 : 1;
  EXPECT_EQ(unconverged, 0);
  const double middle = 0.5 * (inner + outer);
  LongFlow end{
      ring(body.points, middle - h, middle + h).lambda,
      std::max(ring(body.points, inner, inner + h).lambda, ring(body.points, outer - h, outer).lambda), 0.0,
      0.0};
  double plug_now = 0.0, plug_then = 0.0;
  for (int c = 4; c < 16; ++c) {
    const double then = volume[static_cast<std::size_t>(c - 4)];
    end.ring_off = std::max(end.ring_off, std::abs(ring_at(c) / then - 1.0));
    if (c >= 8 && c < 12) plug_now += ring_at(c), plug_then += then;
  }
  end.plug_off = std::abs(plug_now / plug_then - 1.0);
  std::printf(
      "%d steps: lambda %.5f in the plug, %.1e at the walls; plug's volume %.1e off, worst ring's %.1e\n",
      steps, end.in_plug, end.at_walls, end.plug_off, end.ring_off);
  return end;
}

// The shear stress is (f/2)(r - r_1 r_2/r), with a plug from r_1 to r_2 = r_1 + 2 tau_0/f: with equal speeds on both sides it
// lies within half a cell of the middle. There structure only builds up, lambda = A_thix t/tau_0 = 1 at the end; next to the walls
// the rate is above 1 1/s, and what was built up has broken down. The plug's concrete is looked for in its middle two cells.
TEST(LongFlow, StructureAndVolumeKeepTheirPlace) {
  const LongFlow end = flow_long({});
  EXPECT_NEAR(end.in_plug, A_thix * duration / tau_0, 0.01);
  EXPECT_LE(end.at_walls, 0.01);
  EXPECT_LE(end.ring_off, 0.2);  // a ring holds twelve points: 8 % for one that strays
}

// Particle shifting answers to cells that hold a point too many by chance. As a pour has it, it leaves the plug alone: without
// its share of rigid cells lambda is 0.5 here, and rings are empty or hold twice their volume. Sheared rings of twelve points are
// still filled and emptied by some of them (docs/theory/mpm_step.md), by rounding: 0.42 of a ring's volume on one processor, 0.64
// on another.
TEST(LongFlow, ShiftingLeavesThePlugAlone) {
  const LongFlow end = flow_long({.on = true, .rigid_share = 0.1});
  EXPECT_NEAR(end.in_plug, A_thix * duration / tau_0, 0.05);
  EXPECT_LE(end.at_walls, 0.01);
  EXPECT_LE(end.plug_off, 0.2);
  EXPECT_LE(end.ring_off, 0.85);
}

}  // namespace
}  // namespace tremie
