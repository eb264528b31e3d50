// Case 7: the L-box at rest, against the thin-layer closed form.

#include <fmt/format.h>

#include "apparatus/verification/references/lbox_case.hpp"
#include "apparatus/verification/suite.hpp"

namespace tremie::verification {
namespace {

Run at_rest(double cell, bool side_walls) {
  const l_box::Scene scene = lbox_reference::scene_of(50.0, cell, side_walls);
  const double start = cpu_seconds();
  const l_box::Outcome outcome = l_box::run(scene);
  return {fmt::format("{:g} mm", 1e3 * cell), cell, lbox_reference::compare(scene, outcome).error.worst,
          cpu_seconds() - start, unconverged(outcome.checks.unconverged_steps)};
}

}  // namespace

Case l_box_case(Depth depth) {
  Problem one{
      .name = "l_box_at_rest",
      .title = "The profile of the L-box at rest",
      .equation = "50 Pa, 30 Pa·s, gate at 30 cm/s, 180 s",
      .reference =
          "F(h) − F(h2) = (τ0/ρg)(L − x) from 100 mm behind the gate on, at the volume there; F = "
          "h²/2, or with side walls (W/2)[h − (W/2) ln(1 + 2h/W)]",
      .norm = "largest mean of h / h_exact − 1 over 100 mm",
      .series = {{"plane", {}}, {"plane with side walls", {}}},
      .notes = {
          "Within a depth of the gate concrete falls from the column's walls, and a bed at its "
          "yield stress bears it: lbox_study.md has how high.",
          "Between side walls the bed rests at its yield stress all along, and steeper than the closed form, "
          "which leaves out the plug's normal stress: the bound is 1.5 % and what that may hold, 3.3 %."}};
  for (Series& series : one.series) {
    const bool side_walls = &series != &one.series.front();
    for (double cell : {0.02, 0.01, 0.005})
      if (cell > 0.005 || depth == Depth::full) series.runs.push_back(at_rest(cell, side_walls));
    constexpr double depth_at_the_end = 0.05;
    const double limit =
        side_walls ? 0.015 + lbox_reference::share_of_the_plug(50.0, depth_at_the_end) : 0.03;
    one.bounds.push_back(
        {.what = series.scheme + ": error at 10 mm", .value = series.runs[1].error, .limit = limit});
    if (depth == Depth::full)
      one.bounds.push_back(
          {.what = series.scheme + ": error at 5 mm", .value = series.runs[2].error, .limit = limit});
  }
  return {7, "The L-box at rest", {one}};
}

}  // namespace tremie::verification
