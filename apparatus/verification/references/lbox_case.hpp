#pragma once

// The L-box of the tests, the study and the verification suite (30 Pa s, cubes of cells, 180 s at most), and what it is held
// against: the closed form of its profile at rest.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "apparatus/l_box/l_box.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::lbox_reference {

inline constexpr double rho_g = 2400.0 * gravity;

/// Thin-layer profile at rest against an end wall: F(h) - F(h2) = (tau_0 / rho g)(L - x), F = h^2/2 without
/// side walls (width = 0) and (W/2)[h - (W/2) ln(1 + 2h/W)] with them.
struct Profile {
  double tau_0 = 0.0, width = 0.0, end = 0.0, h2 = 0.0;

  double F(double h) const {
    return width > 0.0 ? 0.5 * width * (h - 0.5 * width * std::log1p(2.0 * h / width)) : 0.5 * h * h;
  }
  double depth(double x) const {
    const double target = F(h2) + tau_0 / rho_g * (end - x);
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double h = 0.5 * (low + high);
      (F(h) < target ? low : high) = h;
    }
    return 0.5 * (low + high);
  }
};

/// The closed form at the volume of a measured profile (distance from the gate, depth; even steps).
inline Profile at_the_volume_of(const std::vector<std::array<double, 2>>& measured, double tau_0,
                                double width, double end) {
  double sum = 0.0;
  for (const auto& [x, h] : measured) sum += h;
  double low = 0.0, high = 0.5;
  for (int i = 0; i < 50; ++i) {
    const Profile profile{tau_0, width, end, 0.5 * (low + high)};
    double of_form = 0.0;
    for (const auto& [x, h] : measured) of_form += profile.depth(x);
    (of_form < sum ? low : high) = profile.h2;
  }
  return {tau_0, width, end, 0.5 * (low + high)};
}

/// H2/H1 of a profile, over the stretches of apparatus/parts/boxes/reading.hpp: 60 mm long, 20 mm off the walls.
inline double passing_ratio(const Profile& profile) {
  return profile.depth(profile.end - 0.05) / profile.depth(-0.05);
}

/// How far the plug's normal stress, which the closed form leaves out, may take a bed at its yield stress off it: a share of
/// the depth h. The plug is pressed together before the end wall and stretched behind the gate, by up to tau_0 where the
/// floor's shear leaves room: sigma_xx - sigma_zz over the depth is up to (pi/2) tau_0 h (Balmforth and Craster, J.
/// Non-Newtonian Fluid Mech. 84 (1999) 65), which is rho g h times a depth of (pi/2) tau_0 / (rho g); half of that at each end
/// keeps the volume.
inline double share_of_the_plug(double tau_0, double h) {
  return 0.25 * std::numbers::pi * tau_0 / (rho_g * h);
}

/// Concrete that falls off the column's walls lands within a depth of the gate and may stand there above the
/// profile: a heap on a deep bed of yield stress tau_0 is a chunk on a cohesive ground, which bears (2 + pi)
/// tau_0. Depth of such a heap [m].
inline double heap_that_is_borne(double tau_0) { return (2.0 + std::numbers::pi) * tau_0 / rho_g; }

/// Where the closed form is to hold: from a depth behind the gate on [m].
inline constexpr double heap_ends = 0.1;

/// The part of a profile from heap_ends on.
inline std::vector<std::array<double, 2>> beyond_the_heap(const std::vector<std::array<double, 2>>& profile) {
  std::vector<std::array<double, 2>> part;
  for (const auto& station : profile)
    if (station[0] > heap_ends) part.push_back(station);
  return part;
}

/// How far the mean depth before heap_ends is above the closed form [m].
inline double heap(const std::vector<std::array<double, 2>>& profile, const Profile& form) {
  double sum = 0.0;
  int n = 0;
  for (const auto& [x, h] : profile)
    if (x < heap_ends) sum += h - form.depth(x), ++n;
  return sum / n;
}

/// Relative errors of a measured profile: root mean square of its stations, and the worst of their means over
/// 100 mm (a station is two cells, and a drop on it a few millimetres).
struct ProfileError {
  double rms = 0.0, worst = 0.0;
};

inline ProfileError error_of(const std::vector<std::array<double, 2>>& measured, const Profile& profile) {
  constexpr double part = 0.1;
  std::vector<double> sum(static_cast<std::size_t>(std::lround(profile.end / part)), 0.0);
  std::vector<int> count(sum.size(), 0);
  ProfileError error;
  for (const auto& [x, h] : measured) {
    const double e = h / profile.depth(x) - 1.0;
    error.rms += e * e / static_cast<double>(measured.size());
    const auto k = std::min(sum.size() - 1, static_cast<std::size_t>(x / part));
    sum[k] += e;
    ++count[k];
  }
  error.rms = std::sqrt(error.rms);
  for (std::size_t k = 0; k < sum.size(); ++k)
    if (count[k] > 0) error.worst = std::max(error.worst, std::abs(sum[k] / count[k]));
  return error;
}

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
