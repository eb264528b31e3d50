// Reasons why a funnel's result is not to be trusted.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/parts/funnel/funnel.hpp"
#include "apparatus/run/run_checks.hpp"

namespace tremie::funnel {
namespace {

/// The fastest mean speed in the mouth [m/s].
double fastest_in_the_mouth(const View& v) {
  const Shape& s = v.scene.shape;
  const double area = s.depth == 0.0 ? 0.25 * std::numbers::pi * s.mouth * s.mouth : s.mouth * s.depth;
  double most = 0.0;
  for (const Sample& line : v.series) most = std::max(most, line.discharge / area);
  return most;
}

std::string inertia(const View& v) {
  return experiment::inertia_on_a_cell(v.scene.mix, v.scene.model.law, fastest_in_the_mouth(v),
                                       v.scene.model.cell[1]);
}

/// Measured: five cells to the half of the mouth make the inverted cone 15 % too fast with walls that hold and 5 % with walls
/// along which a layer slides, ten 1.3 and 2.5 %; the V-funnel is 13 % too slow with three, 3 % with five,
/// and cells 1.6 times as high as wide change it by 0.2 %.
std::string few_cells_in_the_mouth(const View& v) {
  if (v.r.stopped_at) return {};  // where the yield stress holds it the cells do not matter
  const Shape& s = v.scene.shape;
  const double least = s.depth == 0.0 ? 8.0 : 6.0, most_slender = s.depth == 0.0 ? 1.0 : 1.6;
  const auto [across, up] = v.scene.model.cell;
  const double cells = 0.5 * s.mouth / std::max(across, up / most_slender);
  if (cells > least * (1.0 - 1e-6)) return {};
  return fmt::format(
      "half of the mouth is {:.2g} cells wide, fewer than {:g}: the discharge may be off by more than 3 %; "
      "use a "
      "smaller model.cell",
      cells, least);
}

std::string few_points(const View& j) { return experiment::one_point_a_cell(j.scene.model); }

std::string lost_volume(const View& v) {
  constexpr double most = 0.01;
  if (!(std::abs(v.r.volume_error) > most)) return {};
  return fmt::format(
      "discharged plus remaining volume differs by {:+.2g} % from the initial volume, more than {:g} %: "
      "use a larger mix.bulk_modulus or a smaller model.cell",
      100.0 * v.r.volume_error, 100.0 * most);
}

std::string no_number(const View& v) {
  return std::isfinite(v.r.emptied) && std::isfinite(v.r.volume_error)
             ? std::string{}
             : "the discharged volume is not a finite number";
}

}  // namespace

void add_reasons(const Scene& scene, Outcome& outcome) {
  scene::add_reasons<View>({inertia, few_cells_in_the_mouth, few_points, lost_volume, no_number},
                           {scene, outcome}, outcome.checks.reasons);
}

}  // namespace tremie::funnel
