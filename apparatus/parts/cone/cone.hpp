#pragma once

// The Abrams cone: the concrete that fills it, and its wall while it is lifted.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "apparatus/parts/cone/cone_test.hpp"
#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/constitutive/equation_of_state.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie::cone {

inline double inner_radius(const Cone& cone, double z) {
  return cone.bottom_radius + (cone.top_radius - cone.bottom_radius) * z / cone.height;
}

/// Fills the cone with rings of points under hydrostatic pressure. Rows of height dz, each divided into rings
/// about dr wide that end at the wall, so that the volume is the cone's to round-off.
inline void fill(const Cone& cone, const Mix& mix, double g, double dr, double dz, Points<2>& points) {
  const int rows = std::max(1, static_cast<int>(std::lround(cone.height / dz)));
  const double row = cone.height / rows;
  for (int j = 0; j < rows; ++j) {
    const double z = (j + 0.5) * row;
    const double low = inner_radius(cone, j * row), high = inner_radius(cone, (j + 1) * row);
    const double R =
        std::sqrt((low * low + low * high + high * high) / 3.0);  // the row's volume is pi R^2 row
    const int rings = std::max(1, static_cast<int>(std::lround(R / dr)));
    for (int i = 0; i < rings; ++i) {
      const double inner = R * i / rings, outer = R * (i + 1) / rings;
      const double V = std::numbers::pi * (outer * outer - inner * inner) * row;
      const double ln_J = ln_J_under(mix.density * g * (cone.height - z), mix.K);
      add_point<2>(points, {0.5 * (inner + outer), z}, mix.density * V, V * std::exp(-ln_J), ln_J);
    }
  }
}

/// The same rows and rings in space: each ring is points of equal volume about dr apart along it, the same in
/// all four quadrants; `quarter`: those of the first alone.
inline void fill(const Cone& cone, const Mix& mix, double g, double dr, double dz, bool quarter,
                 Points<3>& points) {
  Points<2> rings;
  fill(cone, mix, g, dr, dz, rings);
  const double right = 0.5 * std::numbers::pi;
  const auto in_quadrant = [&](const Vec<2>& ring) {
    return std::max(1, static_cast<int>(std::lround(right * ring[0] / dr)));
  };
  std::size_t all = 0;
  for (const Vec<2>& ring : rings.x) all += static_cast<std::size_t>(in_quadrant(ring)) * (quarter ? 1 : 4);
  reserve(points, points.size() + all);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const double r = rings.x[i][0], z = rings.x[i][1];
    const int n = in_quadrant(rings.x[i]);
    for (int k = 0; k < n; ++k) {
      const double x = r * std::cos(right * (k + 0.5) / n), y = r * std::sin(right * (k + 0.5) / n);
      for (int quadrant = 0; quadrant < (quarter ? 1 : 4); ++quadrant)
        add_point<3>(points, {quadrant & 1 ? -x : x, quadrant & 2 ? -y : y, z}, rings.mass[i] / (4 * n),
                     rings.V0[i] / (4 * n), rings.ln_J[i]);
    }
  }
}

/// Height of the cone's rim at a time [m].
inline double rim_height(const Scene& scene, double time) { return *scene.lift_speed * time; }

/// The inner wall of the cone as it is lifted; points within `reach` of it [m] may touch it.
inline RigidWall<2> lifted_wall(const Scene& scene, double reach) {
  const Cone cone = scene.cone;
  const double speed = *scene.lift_speed;
  const double taper = cone.bottom_radius - cone.top_radius;
  const double slant = std::hypot(cone.height, taper);
  const Vec<2> normal(-cone.height / slant, -taper / slant);
  return [=](const Vec<2>& x, double time) -> std::optional<WallView<2>> {
    const double above_rim = x[1] - speed * time;
    if (above_rim < 0.0 || above_rim > cone.height) return std::nullopt;
    const double gap = normal.dot(x - Vec<2>(cone.bottom_radius, speed * time));
    if (std::abs(gap) > reach) return std::nullopt;
    return WallView<2>{gap, normal, Vec<2>(0.0, speed)};
  };
}

/// A lift beside which steps are short: the longest [s], and the rise of the rim until which they are [m].
struct SlowLift {
  double step, rise;
};

/// How short the steps are beside a slow cone; empty for a fast one. What a wall gives way in a step
/// grows with the step's square. Up to 20 mm/s the wall is as stiff as it may be (slow_wall_factor()); in steps of 20 to 30
/// ms 2 to 3 % of the concrete went through it before the rim had risen by a cell, and t500 scattered by 5 %. From there to
/// 8 cm/s t500 was up to 11 % too early (lift.md).
inline std::optional<SlowLift> slow_lift(const Scene& scene) {
  struct Lift {
    double fastest, step, cells;  // [m/s], [s], rise of the rim that it lasts for [cells]
  };
  for (const Lift lift : {Lift{0.0203, 0.003, 1.0}, Lift{0.08, 0.006, 8.0}})
    if (scene.lift_speed && *scene.lift_speed <= lift.fastest)
      return SlowLift{lift.step, lift.cells * scene.model.cell[1]};
  return std::nullopt;
}

/// Longest step [s] while the wall of a slow cone stands beside the concrete, infinite else.
inline double longest_step_beside_the_cone(const Scene& scene, double time) {
  const auto slow = slow_lift(scene);
  return slow && rim_height(scene, time) < slow->rise ? slow->step * scene.model.step_scale
                                                      : std::numeric_limits<double>::infinity();
}

/// Share of the volume that stands above the lifted cone's rim, but not within its wall.
template <int D>
double share_behind_wall(const Scene& scene, double time, const Points<D>& points) {
  const double rim = rim_height(scene, time);
  double behind = 0.0, all = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double above_rim = points.x[p][D - 1] - rim, r = points.x[p].template head<D - 1>().norm();
    all += points.volume(p);
    if (above_rim > 0.0 && r > inner_radius(scene.cone, above_rim)) behind += points.volume(p);
  }
  return behind / all;
}

/// The wall that a wall in the section (r, z) makes when it is turned about the axis.
inline RigidWall<3> revolved(const RigidWall<2>& section) {
  return [=](const Vec<3>& x, double time) -> std::optional<WallView<3>> {
    const double r = std::hypot(x[0], x[1]);
    const auto view = section({r, x[2]}, time);
    if (!view || r == 0.0) return std::nullopt;
    const auto turn = [&](const Vec<2>& a) { return Vec<3>(a[0] * x[0] / r, a[0] * x[1] / r, a[1]); };
    return WallView<3>{view->gap, turn(view->normal), turn(view->velocity)};
  };
}

}  // namespace tremie::cone
