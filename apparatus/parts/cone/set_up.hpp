#pragma once

// The filled cone before its lift, the settings of its steps, and the wall that is lifted.

#include "apparatus/parts/bars.hpp"
#include "apparatus/parts/cone/cone.hpp"
#include "apparatus/run/body_readings.hpp"
#include "apparatus/run/step_settings.hpp"

namespace tremie::cone {

using experiment::gravity;

/// Whether only the first quadrant is computed, between planes of symmetry.
inline bool is_quarter(const Scene& scene) { return scene.model.space == SpaceKind::quarter; }

/// The filled cone after its rest, before the lift.
template <class Geometry>
Body<Geometry> filled_cone(const Scene& scene) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  Body<Geometry> body;
  body.mix = scene.mix;
  body.gravity[up] = -gravity;
  const auto [h, h_up] = scene.model.cell;
  // Explicit steps have no mirrored splines: their planes of symmetry are slippery walls.
  const FaceKind plane =
      scene.model.scheme == SchemeKind::implicit ? FaceKind::symmetry : FaceKind::free_slip;
  for (int d = 0; d < up; ++d)
    body.grid.axes[d] = {.h = h,
                         .low = D == 2              ? FaceKind::free_slip
                                : is_quarter(scene) ? plane
                                                    : FaceKind::open};
  body.grid.axes[up] = {.h = h_up, .low = face(scene.floor.contact)};
  const auto [n, n_up] = scene.model.points_per_cell;
  if constexpr (D == 2)
    fill(scene.cone, scene.mix, gravity, h / n, h_up / n_up, body.points);
  else
    fill(scene.cone, scene.mix, gravity, h / n, h_up / n_up, is_quarter(scene), body.points);
  shrink(body.points);
  experiment::rest(body, scene.rest);
  return body;
}

/// The bars of a ring, none of them on a plane of symmetry.
inline std::vector<parts::Bar> bars_of(const Ring& ring) {
  std::vector<parts::Bar> bars;
  for (int k = 0; k < ring.bars; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / ring.bars;
    bars.push_back({0.5 * ring.diameter * std::cos(angle), 0.5 * ring.diameter * std::sin(angle),
                    ring.bar_diameter, ring.height});
  }
  return bars;
}

/// Puts the ring of the scene into a body in space; `quarter` has the bars of the first quadrant alone.
inline void add_ring(const Scene& scene, ImplicitBody<ThreeD>& body) {
  if (!scene.ring) return;
  std::vector<parts::Bar> bars = bars_of(*scene.ring);
  if (is_quarter(scene)) std::erase_if(bars, [](const parts::Bar& b) { return b.x < 0.0 || b.y < 0.0; });
  const auto [cell, up] = scene.model.cell;
  if (parts::resolves_bars(cell, scene.ring->bar_diameter))
    parts::add_resolved_bars(bars, 0.5 * std::min(cell, up), body.boundary);
  else
    body.bars = parts::slender_bars(bars, body.grid.axes);
}

inline StepSettings step_settings(const Scene& scene) {
  StepSettings settings = experiment::step_settings(scene.model);
  // The local error chooses the step once the collapse is over; in three dimensions from short ones on.
  const bool section = scene.model.space == SpaceKind::axisymmetric;
  settings.time_error = (section ? 0.002 : 0.005) * scene.model.step_scale * scene.model.step_scale;
  if (!section) settings.dt_max = 0.03 * scene.model.step_scale;
  settings.wall_law = scene.floor.contact;
  settings.settle_on_floor = true;
  settings.wall_gap = 0.5 * scene.model.cell[0] / scene.model.points_per_cell[0];
  return settings;
}

inline void lifted_wall(const Scene& scene, double reach, RigidWall<2>& wall) {
  wall = lifted_wall(scene, reach);
}
inline void lifted_wall(const Scene& scene, double reach, RigidWall<3>& wall) {
  wall = revolved(lifted_wall(scene, reach));
}

/// The two ways to run it, compiled apart.
Outcome run_implicit(const Scene& scene, const scene::Observer& observer);
Outcome run_explicit(const Scene& scene, const scene::Observer& observer);

}  // namespace tremie::cone
