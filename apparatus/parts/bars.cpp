#include "apparatus/parts/bars.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tremie::parts {
namespace {

/// The drag law of a bar has no inertia. In a Newtonian fluid the drag of a cylinder over its speed is 2.5 times
/// as large at a Reynolds number of 10 as at 1 (drag coefficients of 2.8 and 11).
constexpr double most_bar_reynolds = 10.0;

}  // namespace

double bar_reynolds(const Mix& mix, const YieldLaw& law, double speed, double diameter) {
  if (speed == 0.0) return 0.0;
  const double rate = speed / diameter;
  return mix.density * speed * diameter / (mix.mu + viscosity(law, rate, mix.tau_0) + mix.tau_0 / rate);
}

std::vector<BarPoint<3>> slender_bars(const std::vector<Bar>& bars, const std::array<Axis, 3>& axes) {
  std::vector<BarPoint<3>> points;
  for (const Bar& bar : bars) add_bar(axes, {bar.x, bar.y, 0.0}, 2, bar.height, bar.diameter, points);
  std::erase_if(points, [](const BarPoint<3>& p) { return p.x[0] < 0.0 || p.x[1] < 0.0; });
  return points;
}

void add_resolved_bars(const std::vector<Bar>& bars, double spacing, std::vector<BoundaryPoint<3>>& points) {
  for (const Bar& bar : bars) {
    const double R = 0.5 * bar.diameter;
    const int around = std::max(8, static_cast<int>(std::ceil(2.0 * std::numbers::pi * R / spacing)));
    const int rows = static_cast<int>(std::ceil(bar.height / spacing));
    for (int k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + 0.5) / around;
      const double y = bar.y + R * std::sin(angle);
      if (y < 0.0) continue;  // beyond the plane of symmetry
      for (int i = 0; i < rows; ++i) {
        BoundaryPoint<3> point;
        point.x = {bar.x + R * std::cos(angle), y, (i + 0.5) * bar.height / rows};
        points.push_back(point);
      }
    }
  }
}

std::string bars_with_inertia(const Mix& mix, const YieldLaw& law, double speed, double diameter) {
  const double inertia = bar_reynolds(mix, law, speed, diameter);
  if (!(inertia > most_bar_reynolds)) return {};
  return fmt::format(
      "the bars' drag leaves inertia out, and their Reynolds number is {:.3g}, more than {:g}: use a stiffer "
      "mix",
      inertia, most_bar_reynolds);
}

std::string cells_between_bars(double cell, double diameter) {
  const double most = 0.5 * bar_cells_most * diameter;
  if (cell <= most * (1.0 + 1e-9)) return {};
  return fmt::format(
      "cells of {} mm are too large for the gaps between the bars: use a model.cell of at most {} mm",
      std::lround(1e3 * cell), std::lround(1e3 * most));
}

}  // namespace tremie::parts
