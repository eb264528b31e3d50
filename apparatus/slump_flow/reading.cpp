#include "apparatus/slump_flow/reading.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tremie::slump_flow {
namespace {

/// A point belongs to the outline when this many others are less than half a cell behind it; fewer are
/// strays.
constexpr std::size_t company = 3;

struct Weighted {
  double value, volume, size;
};

/// The value beyond which `share` of the total volume lies, plus half the size of the point there.
double upper_quantile(std::vector<Weighted>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  double total = 0.0;
  for (const Weighted& w : sorted) total += w.volume;
  std::sort(sorted.begin(), sorted.end(),
            [](const Weighted& a, const Weighted& b) { return a.value > b.value; });
  double beyond = 0.0;
  for (const Weighted& w : sorted)
    if ((beyond += w.volume) > share * total) return w.value + 0.5 * w.size;
  return sorted.back().value;
}

/// Side of the square that a ring's section is [m].
double section_size(const Points<2>& points, std::size_t p) {
  return std::sqrt(points.volume(p) / (2.0 * std::numbers::pi * std::max(points.x[p][0], 1e-6)));
}

}  // namespace

double spread_of_outermost_point(const Points<2>& points) {
  double r = 0.0;
  for (const auto& x : points.x) r = std::max(r, x[0]);
  return 2.0 * r;
}

double spread(const Points<2>& points, double cell) {
  // Strays aside, the outline lies within a few cells of the outermost point; sorting those is enough.
  double reach = 0.5 * spread_of_outermost_point(points) - 4.0 * cell;
  std::vector<Weighted> radii;
  for (; radii.size() <= company && reach > -4.0 * cell; reach -= 4.0 * cell) {
    radii.clear();
    for (std::size_t p = 0; p < points.size(); ++p)
      if (points.x[p][0] > reach)
        radii.push_back({points.x[p][0], points.volume(p), section_size(points, p)});
  }
  std::sort(radii.begin(), radii.end(),
            [](const Weighted& a, const Weighted& b) { return a.value > b.value; });
  std::size_t i = 0;
  while (i + company < radii.size() && radii[i].value - radii[i + company].value > 0.5 * cell) ++i;
  return radii.empty() ? 0.0 : 2.0 * radii[i].value + radii[i].size;
}

double centre_height(const Points<2>& points, double radius) {
  std::vector<Weighted> heights;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (points.x[p][0] < radius)
      heights.push_back({points.x[p][1], points.volume(p), section_size(points, p)});
  return upper_quantile(heights, 1e-2);
}

}  // namespace tremie::slump_flow
