#pragma once

// The L-box of the tests, the study and the verification suite: 30 Pa s, cubes of cells, 180 s at most.

#include "apparatus/l_box/l_box.hpp"
#include "apparatus/verification/references/lbox_reference.hpp"

namespace tremie::lbox_reference {

inline l_box::Scene scene_of(double tau_0, double cell, bool side_walls) {
  l_box::Scene scene;
  scene.mix.tau_0 = tau_0;
  scene.mix.mu = 30.0;
  scene.duration = 180.0;
  scene.model.space = side_walls ? SpaceKind::plane_with_side_walls : SpaceKind::plane;
  scene.model.cell = {cell, cell};
  scene.model.points_per_cell = {16, 4};
  return scene;
}

/// A run beside the closed form from heap_ends on, at the volume there.
struct Compared {
  Profile form;
  ProfileError error;
  double heap = 0.0, ratio = 0.0;  ///< [m]; H2/H1 of the closed form
};

inline Compared compare(const l_box::Scene& scene, const l_box::Outcome& outcome) {
  const double width = scene.model.space == SpaceKind::plane ? 0.0 : scene.box.width;
  const auto& profile = outcome.results.profile;
  const auto part = beyond_the_heap(profile);
  Compared c;
  c.form = at_the_volume_of(part, scene.mix.tau_0, width, scene.box.channel_length);
  c.error = error_of(part, c.form);
  c.heap = heap(profile, c.form);
  c.ratio = passing_ratio(c.form);
  return c;
}

}  // namespace tremie::lbox_reference
