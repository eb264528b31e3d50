#pragma once

// Reasons of the slump flow itself why a result is not to be trusted.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "apparatus/slump_flow/cone.hpp"
#include "apparatus/slump_flow/set_up.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::slump_flow {

/// Whether the floor bears less than shears the body, which then slides: at most what its law
/// makes of its weight over its area. A regularised law is sheared by any stress; flocculation only adds to the yield stress.
inline bool slides(const Scene& scene, double depth) {
  const double shears = is_exact(scene.model.law) ? scene.mix.tau_0 : 0.0;
  return bears(scene.floor.contact, scene.mix.density * gravity * depth) <= shears;
}

/// Between the floor that holds it and its free surface a body of a cell has no rows of cells to shear: its spread is
/// up to 20 % off (explicit.md), of one without a yield stress, which nothing else holds, still at its last cell but one.
/// From 1.2 cells on a mix with a yield stress is within 5.3 %, by implicit steps in three dimensions from 1.5 on (6.3 % at
/// 1.2, three_d.md). One that slides need not shear: 6 % from half a cell on.
inline void judge_depth(const Scene& scene, Outcome& outcome) {
  const double R = 0.5 * outcome.results.spread, depth = volume(scene.cone) / (std::numbers::pi * R * R);
  const bool in_space =
      scene.model.space != SpaceKind::axisymmetric && scene.model.scheme == SchemeKind::implicit;
  const double rows = slides(scene, depth) ? 0.5 : scene.mix.tau_0 == 0.0 ? 2.0 : in_space ? 1.5 : 1.2;
  const double least = rows * scene.model.cell[1];
  if (depth >= least) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the concrete is thinner than %g cells, %.3g mm on average: a smaller model.cell upwards",
                rows, 1e3 * depth);
  outcome.checks.reasons.push_back(text);
}

/// A section of two cells has no inside, and its few points no outline that could be read.
inline void judge_cells(const Scene& scene, Outcome& outcome) {
  constexpr double least = 3.0;
  const double across = scene.cone.bottom_radius / scene.model.cell[0],
               up = scene.cone.height / scene.model.cell[1];
  if (std::min(across, up) >= least) return;
  char text[160];
  std::snprintf(
      text, sizeof text,
      "the cone is %.2g cells from its axis to its rim and %.2g high, less than %g: a smaller model.cell",
      across, up, least);
  outcome.checks.reasons.push_back(text);
}

/// Nothing lifts the concrete but a cone that it sticks to, in cells that are as large as the gap under its rim.
inline void judge_height(const Scene& scene, Outcome& outcome) {
  double highest = 0.0;
  for (const Sample& s : outcome.series) highest = std::max(highest, s.height);
  if (highest <= 1.05 * scene.cone.height + 0.5 * scene.model.cell[1]) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the concrete stood %.3g mm high, higher than the cone that it came from, which lifted it: a smaller "
      "model.cell, or another test.lift_speed",
      1e3 * highest);
  outcome.checks.reasons.push_back(text);
}

/// In three dimensions the points draw apart in both directions across. With fewer than about one a cell the
/// stresses miss a part of the body, and the spread is 4 to 7 % too far (three_d.md).
inline void judge_points_across(const Scene& scene, Outcome& outcome) {
  if (scene.model.space == SpaceKind::axisymmetric) return;
  constexpr double least = 1.1;
  const double stretch = 0.5 * outcome.results.spread / scene.cone.bottom_radius;
  const double across = scene.model.points_per_cell[0] / std::max(1.0, stretch);
  if (across >= least) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "the body has stretched until a cell holds %.2g points across, and then it spreads too far: "
                "%d or more model.points_per_cell across",
                across, static_cast<int>(std::ceil(1.5 * least * stretch)));
  outcome.checks.reasons.push_back(text);
}

/// The opening under a rim that has risen by less than some cells is narrow to the grid, and lets too little through: at
/// two cells a fluid mix has spread 11 % too little, at one 41 %. In the time of a free fall from the cone's height nothing
/// has flowed yet.
inline void judge_opening(const Scene& scene, Outcome& outcome) {
  constexpr double least = 2.5;
  const double time = outcome.series.back().time, free_fall = std::sqrt(2.0 * scene.cone.height / gravity);
  const double risen = scene.lift_speed ? rim_height(scene, time) / scene.model.cell[1] : least;
  if (risen >= least || time <= free_fall || outcome.status == Status::interrupted) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "the cone's rim has risen by %.2g cells, less than %g: a longer test.duration, or a smaller "
                "model.cell upwards",
                risen, least);
  outcome.checks.reasons.push_back(text);
}

/// Slow lifts are verified down to 5 mm/s (lift.md). At 1 mm/s the section has holes and the spread jumps by 50 mm.
inline void judge_lift_speed(const Scene& scene, Outcome& outcome) {
  constexpr double least = 5e-3;
  if (!scene.lift_speed || *scene.lift_speed >= least) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the cone was lifted at %.2g mm/s; slower than %g mm/s nothing is verified, and the section may "
      "have holes: a faster test.lift_speed",
      1e3 * *scene.lift_speed, 1e3 * least);
  outcome.checks.reasons.push_back(text);
}

/// Concrete that presses on the cone for long goes through its wall, and the opening under a rim that has not
/// risen by a cell is none to the grid. Where a twentieth has by then, t500 is 6 % early; a fiftieth moves it by
/// less than 2 % (lift.md).
inline void judge_lift(Outcome& outcome) {
  constexpr double most = 0.02;
  const auto& through = outcome.results.through_the_cone;
  if (!through || *through <= most) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "%.2g %% of the concrete went through the cone's wall before its rim had risen by a cell: a "
                "faster test.lift_speed, or a smaller model.cell",
                100.0 * *through);
  outcome.checks.reasons.push_back(text);
}

}  // namespace tremie::slump_flow
