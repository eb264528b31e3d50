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

/// What drifts into the wall's cells is put back in every step. In a V-funnel on cells of 10 mm that was a sixth of the concrete
/// by half a cell, with a volume that holds to 0.05 %.
std::string went_through_the_wall(const View& v) {
  constexpr double most = 0.3;
  if (!(v.r.through_the_wall > most)) return {};
  return fmt::format(
      "concrete was pressed into the funnel's wall and put back, in all {:.2g} times its mass by half a "
      "cell, more "
      "than {:g}: use a smaller model.cell",
      v.r.through_the_wall, most);
}

std::string lost_volume(const View& v) {
  constexpr double most = 0.01;
  if (!(std::abs(v.r.volume_error) > most)) return {};
  return fmt::format(
      "what has left and what is left differ by {:+.2g} % from the funnel's volume, more than {:g} %: a "
      "larger "
      "mix.bulk_modulus or a smaller model.cell",
      100.0 * v.r.volume_error, 100.0 * most);
}

std::string no_number(const View& v) {
  return std::isfinite(v.r.emptied) && std::isfinite(v.r.volume_error)
             ? std::string{}
             : "what has left the funnel is not a finite number";
}

}  // namespace

void add_reasons(const Scene& scene, Outcome& outcome) {
  scene::add_reasons<View>({inertia, went_through_the_wall, lost_volume, no_number}, {scene, outcome},
                           outcome.checks.reasons);
}

}  // namespace tremie::funnel
