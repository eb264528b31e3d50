#include "apparatus/l_box/l_box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/parts/boxes/checks.hpp"
#include "apparatus/parts/boxes/reading.hpp"

namespace tremie::l_box {
namespace {

/// In space a thin bed of a fluid mix may level beyond what its yield stress lets it, on cells with few points or a quarter as
/// large as it is deep, or stop before cells that fast flow left half full have been mended (bars.md): the drop is 1.0 times what
/// the yield stress holds at 50 Pa and 1.1 at 20 Pa, but 0.52 at 20 Pa on cells of 20 mm, where the ratio is 0.07 too large. An
/// error of the ratio below 0.05 is none: the drop of 10 Pa is 7 mm, and a reading errs by 1 mm. Bars hold some of the drop at
/// most: a wave that comes back from the end wall may leave the bed alone to hold it.
std::string wrong_level(const boxes::View& j) {
  constexpr double least = 0.6, most = 1.3, in_ratio = 0.05;
  const Results& r = j.r;
  if (j.status != Status::completed || !r.h2 || !in_space(j.scene)) return {};
  const boxes::Stretch gate = boxes::behind_the_gate(j.scene.box), end = boxes::at_the_end(j.scene.box);
  const double length = 0.5 * (end.low + end.high - gate.low - gate.high);
  const double right = drop_at_rest(j.scene, 0.5 * (r.h1 + *r.h2), length);
  Scene without_bars = j.scene;
  without_bars.bars = 0;
  const double bed = drop_at_rest(without_bars, 0.5 * (r.h1 + *r.h2), length);
  const double drop = r.h1 - *r.h2;
  const bool stopped_early = r.stopped_at && drop > most * right;
  const bool too_level = drop < least * bed && bed - drop > in_ratio * r.h1;
  if (!too_level && !stopped_early) return {};
  return fmt::format(
      "H1 - H2 {} {:.2g} mm, but this yield stress sustains {:.2g} mm: {}use model.space "
      "= \"plane_with_side_walls\" for such fluid mixes",
      stopped_early ? "stopped at" : "fell to", 1e3 * drop, 1e3 * (stopped_early ? right : bed),
      stopped_early ? "cells at the channel's end are not full; " : "");
}

/// A column of fewer cells along, which has its walls' films and what is sheared beside them to resolve, is 6 to 18 % too high
/// once it has sunk, at 12 to 171 Pa; on 6.7 cells at most 5 %. A bed that has levelled is right on any.
std::string few_cells_along(const boxes::View& j) {
  constexpr double high = 0.75, least_along = 6.5;
  const double along = j.scene.box.column_length / j.scene.model.cell[0];
  const bool level = j.r.passing_ratio && std::abs(*j.r.passing_ratio - 1.0) < 0.05;
  if (along >= least_along || level || j.r.h1 > high * j.scene.box.column_height) return {};
  return fmt::format(
      "the column is {:.2g} cells long, less than {:g}: H1 may be 5 to 20 % too large; use model.cell = "
      "\"{:.2g} mm\" or less",
      along, least_along, 1e3 * j.scene.box.column_length / least_along);
}

/// A sticky concrete that is read while its column empties: coarse cells are some per cent late, which makes twice as much of H1.
std::string h1_still_falls(const boxes::View& j) {
  constexpr double most = 0.15, least_along = 30.0;
  const auto& series = j.series;
  if (j.status != Status::completed || series.size() < 2) return {};
  const double along = j.scene.box.column_length / j.scene.model.cell[0];
  const double tenth_ago = 0.9 * series.back().time;
  const auto old =
      std::find_if(series.rbegin(), series.rend(), [&](const Sample& s) { return s.time <= tenth_ago; });
  const double fall = old == series.rend() ? 0.0 : old->h1 / j.r.h1 - 1.0;
  if (fall <= most || along >= least_along) return {};
  return fmt::format(
      "H1 fell by {:.2g} % over the last tenth of the time: on {:.2g} cells along the column it may be 5 to "
      "20 % too large; use a longer test.duration, or model.cell = \"{:.2g} mm\" or less",
      100.0 * fall, along, 1e3 * j.scene.box.column_length / least_along);
}

}  // namespace

double drop_at_rest(const Scene& scene, double h, double length) {
  const double held = std::min(scene.mix.tau_0, bears(scene.walls, 0.0));
  const double floor_and_walls = (1.0 / h + (scene.side_walls_slip ? 0.0 : 2.0 / scene.box.width)) * length;
  const double bars = bar_yield_drag * scene.bars * scene.box.bar_diameter / scene.box.width;
  return (held * floor_and_walls + scene.mix.tau_0 * bars) / (scene.mix.density * experiment::gravity);
}

Outcome run(const Scene& scene, const scene::Observer& observer) {
  Outcome outcome = boxes::run(scene, observer);
  scene::add_reasons<boxes::View>({wrong_level, few_cells_along, h1_still_falls}, {scene, outcome},
                                  outcome.checks.reasons);
  return outcome;
}

std::string passing_class(double ratio, int bars) {
  if (ratio < 0.80 || bars == 0) return "";
  return bars == 2 ? "PL1" : "PL2";
}

}  // namespace tremie::l_box
