#include "apparatus/parts/cone/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/common/readings.hpp"
#include "apparatus/parts/cone/cone.hpp"
#include "apparatus/parts/cone/set_up.hpp"
#include "apparatus/run/run_checks.hpp"

namespace tremie::cone {
namespace {

/// Whether the floor bears less than shears the body, which then slides: at most what its law makes of its weight over its
/// area. A regularised law is sheared by any stress; flocculation only adds to the yield stress.
bool slides(const Scene& scene, double depth) {
  const double shears = is_exact(scene.model.law) ? scene.mix.tau_0 : 0.0;
  return bears(scene.floor.contact, scene.mix.density * gravity * depth) <= shears;
}

bool in_a_section(const Scene& scene) { return scene.model.space == SpaceKind::axisymmetric; }
bool is_implicit(const Scene& scene) { return scene.model.scheme == SchemeKind::implicit; }

/// The mean depth at the end.
double mean_depth(const View& j) {
  const double R = 0.5 * j.r.spread;
  return volume(j.scene.cone) / (std::numbers::pi * R * R);
}

/// Between the floor that holds it and its free surface a body of a cell has no rows of cells to shear: its spread is
/// up to 20 % off (three_d.md), of one without a yield stress, which nothing else holds, still at its last cell but one.
/// From 1.2 cells on a mix with a yield stress is within 5.3 %, by implicit steps in three dimensions from 1.5 on (6.3 % at
/// 1.2). One that slides over its floor is within 5 % from 1.1 cells on (90 bodies in cells 0.4 to 4 times as high
/// as wide), 50 % off at 0.6.
std::string too_thin(const View& j) {
  const double depth = mean_depth(j);
  const bool in_space = !in_a_section(j.scene) && is_implicit(j.scene);
  const double rows = j.scene.mix.tau_0 == 0.0 ? 2.0 : in_space ? 1.5 : 1.2;
  if (depth >= rows * j.scene.model.cell[1]) return {};
  return fmt::format(
      "the concrete is thinner than {:g} cells, {:.3g} mm on average: use a smaller model.cell upwards", rows,
      1e3 * depth);
}

/// A section of two cells has no inside, and its few points no outline that could be read. One that slides is 5 % off with three
/// to its rim, one of 1.4 rows on a floor that holds 8 % with 3.2.
std::string few_cells(const View& j) {
  constexpr double least = 3.0;
  const double depth = mean_depth(j);
  const bool low = depth < 2.0 * j.scene.model.cell[1];
  const double least_across = slides(j.scene, depth) ? 4.0 : low ? 3.3 : least;
  const double across = j.scene.cone.bottom_radius / j.scene.model.cell[0],
               up = j.scene.cone.height / j.scene.model.cell[1];
  if (across >= least_across && up >= least) return {};
  const double flat = j.scene.cone.height / j.scene.cone.bottom_radius;
  if (up < least && flat < 0.5)
    return fmt::format(
        "the cone is {:.3g} mm high, {:.2g} of its foot's radius: too low for a slump (cone.height)",
        1e3 * j.scene.cone.height, flat);
  return fmt::format(
      "the cone is {:.2g} cells from its axis to its rim and {:.2g} high, less than {:g} across or "
      "{:g} up: use a smaller model.cell",
      across, up, least_across, least);
}

/// Slender upright cells: a rim of 4 cells across that are 20 times as high is read 12 % too far while the body still stands.
std::string upright_cells(const View& j) {
  constexpr double most = 4.0;
  const double slender = j.scene.model.cell[1] / j.scene.model.cell[0];
  if (slender <= most) return {};
  return fmt::format(
      "the cells are {:.2g} times as high as wide, more than {:g}: use a smaller model.cell upwards", slender,
      most);
}

/// In three dimensions the points draw apart in both directions across. With fewer than about one a cell the
/// stresses miss a part of the body, and the spread is 4 to 7 % too far (three_d.md).
std::string few_points_across(const View& j) {
  if (in_a_section(j.scene) || !is_implicit(j.scene)) return {};
  constexpr double least = 1.1;
  const double stretch = 0.5 * j.r.spread / j.scene.cone.bottom_radius;
  const double across = j.scene.model.points_per_cell[0] / std::max(1.0, stretch);
  if (across >= least) return {};
  return fmt::format(
      "the body has stretched to {:.2g} points a cell across, and then it spreads too far: use {} or "
      "more model.points_per_cell across",
      across, static_cast<int>(std::ceil(1.5 * least * stretch)));
}

std::string few_points(const View& j) { return experiment::one_point_a_cell(j.scene.model); }

/// Slow lifts are verified down to 5 mm/s (lift.md). At 1 mm/s the section has holes and the spread jumps by 50 mm.
std::string slow_lift_unverified(const View& j) {
  constexpr double least = 5e-3;
  if (!j.scene.lift_speed || *j.scene.lift_speed >= least) return {};
  return fmt::format(
      "the cone was lifted at {:.2g} mm/s; nothing is verified below {:g} mm/s, and the section may "
      "have holes: use a faster test.lift_speed",
      1e3 * *j.scene.lift_speed, 1e3 * least);
}

/// The opening under a rim that has risen by less than some cells is narrow to the grid, and lets too little through: at
/// two cells a fluid mix has spread 11 % too little, at one 41 %. In the time of a free fall from the cone's height nothing
/// has flowed yet.
std::string narrow_opening(const View& j) {
  constexpr double least = 2.5;
  const double time = j.series.back().time, free_fall = std::sqrt(2.0 * j.scene.cone.height / gravity);
  const double risen = j.scene.lift_speed ? rim_height(j.scene, time) / j.scene.model.cell[1] : least;
  if (risen >= least || time <= free_fall || j.status == Status::interrupted) return {};
  return fmt::format(
      "the cone's rim has risen by {:.2g} cells, less than {:g}: use a longer test.duration, or a "
      "smaller model.cell upwards",
      risen, least);
}

/// Where the floor hardly holds, concrete slides out below a rim that has risen by a part of a cell, which is no opening to the
/// grid, and what it holds back meanwhile comes to rest nearer. Over cells that the rim passes in the time of a free fall from
/// the cone's height the spread is 3 % too small at most, in 1.2 times that 6 to 10 %, in three times up to 39 %; a floor that
/// bears twice the yield stress holds it as one that does not slide: 2 % in 6 times that (lift.md).
std::string slow_lift_over_a_slippery_floor(const View& j) {
  if (!j.scene.lift_speed) return {};
  const double holds = bears(j.scene.floor.contact, j.scene.mix.density * gravity * mean_depth(j));
  const double risen = *j.scene.lift_speed * std::sqrt(2.0 * j.scene.cone.height / gravity);
  if (holds > 2.0 * j.scene.mix.tau_0 || j.scene.model.cell[1] <= risen) return {};
  return fmt::format(
      "the lift is too slow for a sliding floor: the rim rises {:.2g} cells in the time of a free fall from "
      "the cone's height, less than 1: use a smaller model.cell upwards, or a faster test.lift_speed",
      risen / j.scene.model.cell[1]);
}

/// Nothing lifts the concrete but a cone that it sticks to, in cells that are as large as the gap under its rim.
std::string lifted_by_the_cone(const View& j) {
  double highest = 0.0;
  for (const Sample& s : j.series) highest = std::max(highest, s.height);
  if (highest <= 1.05 * j.scene.cone.height + 0.5 * j.scene.model.cell[1]) return {};
  if (j.scene.cone.bottom_radius < j.scene.cone.top_radius)
    return fmt::format(
        "the concrete stood {:.3g} mm high: it did not leave the cone, which is narrower below and lifted "
        "it: use a more fluid mix, a faster test.lift_speed, or \"instant\"",
        1e3 * highest);
  return fmt::format(
      "the concrete stood {:.3g} mm high, higher than its cone, which lifted it: use a smaller "
      "model.cell, or another test.lift_speed",
      1e3 * highest);
}

double fastest(const std::vector<Sample>& series) {
  double speed = 0.0;
  for (const Sample& s : series) speed = std::max(speed, s.max_speed);
  return speed;
}

std::string inertia(const View& j) {
  return experiment::inertia_on_a_cell(j.scene.mix, j.scene.model.law, fastest(j.series),
                                       j.scene.model.cell[1]);
}

std::string no_number(const View& v) {
  return std::isfinite(v.r.spread) ? std::string{} : "the spread is not a finite number";
}

}  // namespace

/// Concrete that presses on the cone for long goes through its wall, and the opening under a rim that has not
/// risen by a cell is none to the grid. Where a twentieth has by then, t500 is 6 % early; a fiftieth moves it by
/// less than 2 %.
std::string went_through_the_cone(const View& j) {
  constexpr double most = 0.02;
  const auto& through = j.r.through_the_cone;
  if (!through || *through <= most) return {};
  return fmt::format(
      "{:.2g} % of the concrete went through the cone's wall before its rim had risen by a cell: use a "
      "faster test.lift_speed, or a smaller model.cell",
      100.0 * *through);
}

void add_reasons(const Scene& scene, Outcome& outcome) {
  scene::add_reasons<View>({too_thin, few_cells, upright_cells, few_points, few_points_across,
                            went_through_the_cone, slow_lift_unverified, slow_lift_over_a_slippery_floor,
                            narrow_opening, lifted_by_the_cone, inertia, no_number},
                           {scene, outcome}, outcome.checks.reasons);
}

}  // namespace tremie::cone
