#include "apparatus/parts/boxes/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/common/readings.hpp"
#include "apparatus/parts/boxes/reading.hpp"
#include "apparatus/run/run_checks.hpp"

namespace tremie::boxes {
namespace {

/// The last line of the series that is at least standing_lasts old; the end of the series where there is none.
std::vector<Sample>::const_iterator line_before(const std::vector<Sample>& series) {
  const auto old = std::find_if(series.rbegin(), series.rend(), [&](const Sample& s) {
    return s.time <= series.back().time - standing_lasts;
  });
  return old == series.rend() ? series.end() : std::prev(old.base());
}

std::string inertia_at_the_bars(const View& j) {
  if (j.scene.bars == 0) return {};
  return parts::bars_with_inertia(j.scene.mix, j.scene.model.law, fastest_front(j.series),
                                  j.scene.box.bar_diameter);
}

/// The drag of a bar between cells that resolve it and those for which it was measured; and a gap wants two cells.
std::string wide_cells_at_the_bars(const View& j) {
  return j.scene.bars > 0 && in_space(j.scene)
             ? parts::cells_between_bars(j.scene.model.cell[0], j.scene.box.bar_diameter)
             : std::string{};
}

/// Depths and how far they reach are the grid's where a few cells make them: below these the passing ratio is
/// up to 40 % off (lbox_study.md), and H2 6 % on 1.1 cells.
constexpr double least_behind_the_gate = 3.5, least_at_the_end = 1.25;  // [cells]

std::string few_cells(const View& j) {
  const double up = j.scene.model.cell[1];
  const Results& r = j.r;
  const char* mend = ": use a smaller model.cell";
  if (r.h1 < least_behind_the_gate * up)
    return fmt::format("the concrete behind the gate is {:.2g} cells deep, less than {:.2g}{}", r.h1 / up,
                       least_behind_the_gate, mend);
  if (r.h2 && *r.h2 < least_at_the_end * up)
    return fmt::format("the concrete at the channel's end is {:.3g} mm deep, less than {:g} cells{}",
                       1e3 * *r.h2, least_at_the_end, mend);
  return {};
}

/// A column that its walls nearly carry sinks by what they leave: at 600 Pa H1 is 6 % too large on cells of a tenth of the
/// column's length and 14 % on a fifth. One that they carry, and one that they hardly do, hang on the cells less.
constexpr double carried_from = 0.45, carried_to = 1.2, cells_along_a_carried_column = 30.0;

std::string walls_carry_the_column(const View& j) {
  const Scene& s = j.scene;
  constexpr double stands = 0.98;  // of the column's height
  if (s.pour || face(s.walls) != FaceKind::no_slip || j.r.h1 > stands * s.box.column_height) return {};
  const double tau_y = static_yield_stress(j.r.flocculation_mean_end.value_or(0.0), s.mix.tau_0);
  const double per_length =
      1.0 / s.box.column_length + (s.model.space == SpaceKind::plane ? 0.0 : 1.0 / s.box.width);
  const double carried = 2.0 * tau_y * per_length / (s.mix.density * gravity);
  if (carried < carried_from || carried > carried_to) return {};
  const double along = s.box.column_length / *std::max_element(s.model.cell.begin(), s.model.cell.end());
  if (along >= cells_along_a_carried_column) return {};
  return fmt::format(
      "the column's walls carry {:.2g} of its weight, and {:.2g} cells along it do not resolve the "
      "sheared layer beside them: H1 may be 5 to 20 % too large; use model.cell = \"{:.2g} mm\" or less",
      carried, along, 1e3 * s.box.column_length / cells_along_a_carried_column);
}

std::string few_points(const View& j) { return experiment::one_point_a_cell(j.scene.model); }

std::string inertia(const View& j) {
  return experiment::inertia_on_a_cell(j.scene.mix, j.scene.model.law, fastest_front(j.series),
                                       j.scene.model.cell[1]);
}

/// The opening under a gate that has risen by less than some cells is narrow to the grid, as that under a cone. One of a
/// twentieth of a cell lets next to nothing through, and so does the grid.
std::string narrow_opening(const View& j) {
  constexpr double least = 2.5, shut = 0.05;
  const double edge = gate_edge(j.scene, j.series.back().time), risen = edge / j.scene.model.cell[1];
  if (risen >= least || risen <= shut || edge >= j.scene.box.channel_height ||
      j.status == Status::interrupted)
    return {};
  return fmt::format(
      "the gate has risen by {:.2g} cells, less than {:g}: use a longer test.duration, or a smaller "
      "model.cell "
      "upwards",
      risen, least);
}

/// The gate stands on a face of the grid.
std::string gate_beside_its_place(const View& j) {
  constexpr double most = 0.01;
  const double L = j.scene.box.column_length,
               off = place_of_gate(along_the_channel(j.scene.box, j.scene.model.cell[0])) - L;
  if (std::abs(off) <= most * L) return {};
  return fmt::format(
      "no cells of about this size have a face at the gate, which stands {:.2g} mm beside it: use another "
      "model.cell",
      1e3 * std::abs(off));
}

std::string no_number(const View& v) {
  return std::isfinite(v.r.h1) ? std::string{} : "H1 is not a finite number";
}

}  // namespace

std::string went_through_the_wall(const View& j) {
  const double through = j.series.back().through_the_wall;
  if (through <= most_through_the_wall) return {};
  return fmt::format(
      "{:.2g} % of the concrete went through the shut gate or the wall above it: use a smaller "
      "model.cell, "
      "or a shorter model.time_step",
      100.0 * through);
}

double fastest_front(const std::vector<Sample>& series) {
  double speed = 0.0;
  for (std::size_t i = 1; i < series.size(); ++i)
    if (series[i].time > series[i - 1].time)
      speed =
          std::max(speed, (series[i].front - series[i - 1].front) / (series[i].time - series[i - 1].time));
  return speed;
}

std::optional<double> stands_since(const std::vector<Sample>& series) {
  const auto old = line_before(series);
  if (old == series.end()) return std::nullopt;
  const auto moved = [](double a, double b) { return std::abs(a - b) > standing_within; };
  for (auto s = old; s != series.end(); ++s)
    if (moved(s->h1, old->h1) || moved(s->front, old->front) || s->h2.has_value() != old->h2.has_value() ||
        (s->h2 && moved(*s->h2, *old->h2)))
      return std::nullopt;
  return old->time;
}

std::optional<double> ratio_change(const std::vector<Sample>& series) {
  const auto old = line_before(series);
  const Sample& last = series.back();
  if (old == series.end() || !old->h2 || !last.h2 || old->h1 <= 0.0 || last.h1 <= 0.0) return std::nullopt;
  return (*last.h2 / last.h1 - *old->h2 / old->h1) / (last.time - old->time);
}

void add_reasons(const Scene& scene, Outcome& outcome) {
  scene::add_reasons<View>(
      {inertia_at_the_bars, wide_cells_at_the_bars, few_cells, walls_carry_the_column, few_points,
       went_through_the_wall, narrow_opening, gate_beside_its_place, inertia, no_number},
      {scene, outcome}, outcome.checks.reasons);
}

}  // namespace tremie::boxes
