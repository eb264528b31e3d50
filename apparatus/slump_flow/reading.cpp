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

/// Side of the cube that a point stands for [m].
double section_size(const Points<3>& points, std::size_t p) { return std::cbrt(points.volume(p)); }

double squared_radius(const Vec<2>& x) { return x[0] * x[0]; }
double squared_radius(const Vec<3>& x) { return x[0] * x[0] + x[1] * x[1]; }

template <int D>
double outermost_radius(const Points<D>& points) {
  double r2 = 0.0;
  for (const auto& x : points.x) r2 = std::max(r2, squared_radius(x));
  return std::sqrt(r2);
}

/// Whether a place is further out than `reach`, which may be negative.
template <class Place>
bool beyond(const Place& x, double reach) {
  return reach < 0.0 || squared_radius(x) > reach * reach;
}

/// How far out the concrete reaches: the outermost value that has company, plus half the size of its point.
double reach_of(std::vector<Weighted>& out, double cell) {
  // Few are strays, so that a look at the outermost is nearly always enough.
  for (std::size_t n = std::min<std::size_t>(out.size(), 32); n > 0; n = out.size()) {
    std::partial_sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(n), out.end(),
                      [](const Weighted& a, const Weighted& b) { return a.value > b.value; });
    std::size_t i = 0;
    while (i + company < n && out[i].value - out[i + company].value > 0.5 * cell) ++i;
    if (i + company < n || n == out.size()) return out[i].value + 0.5 * out[i].size;
  }
  return 0.0;
}

/// Numbers of the points that may lie on the outline: strays aside, within a few cells of the outermost.
template <int D>
std::vector<std::size_t> points_far_out(const Points<D>& points, double cell) {
  std::vector<std::size_t> far;
  double reach = outermost_radius(points) - 4.0 * cell;
  for (; far.size() <= company && reach > -4.0 * cell; reach -= 4.0 * cell) {
    far.clear();
    for (std::size_t p = 0; p < points.size(); ++p)
      if (beyond(points.x[p], reach)) far.push_back(p);
  }
  return far;
}

template <int D>
double height_within(const Points<D>& points, double reach) {
  std::vector<Weighted> heights;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (squared_radius(points.x[p]) < reach * reach)
      heights.push_back({points.x[p][D - 1], points.volume(p), section_size(points, p)});
  return upper_quantile(heights, 1e-2);
}

}  // namespace

double spread_of_outermost_point(const Points<2>& points) { return 2.0 * outermost_radius(points); }
double spread_of_outermost_point(const Points<3>& points) { return 2.0 * outermost_radius(points); }

double spread(const Points<2>& points, double cell) {
  std::vector<Weighted> radii;
  for (std::size_t p : points_far_out(points, cell))
    radii.push_back({points.x[p][0], points.volume(p), section_size(points, p)});
  return 2.0 * reach_of(radii, cell);
}

double spread(const Points<3>& points, double cell, bool quarter) {
  // 16 directions over the full turn, opposite ones make a diameter; a quarter has four of its own.
  const int directions = quarter ? 4 : 16;
  const double turn = 2.0 * std::numbers::pi / 16.0;
  const std::vector<std::size_t> far = points_far_out(points, cell);
  std::vector<double> size;
  for (std::size_t p : far) size.push_back(section_size(points, p));
  double sum = 0.0;
  std::vector<Weighted> out;
  for (int k = 0; k < directions; ++k) {
    const double angle = turn * (k + 0.5);
    const double ex = std::cos(angle), ey = std::sin(angle);
    out.clear();
    for (std::size_t i = 0; i < far.size(); ++i)
      for (int mirror = 0; mirror < (quarter ? 4 : 1); ++mirror) {
        const Vec<3>& at = points.x[far[i]];
        const double x = mirror & 1 ? -at[0] : at[0], y = mirror & 2 ? -at[1] : at[1];
        if (const double a = ex * x + ey * y; a > 0.0) out.push_back({a, 0.0, size[i]});
      }
    sum += reach_of(out, cell);
  }
  return 2.0 * sum / directions;
}

double centre_height(const Points<2>& points, double reach) { return height_within(points, reach); }
double centre_height(const Points<3>& points, double reach) { return height_within(points, reach); }

}  // namespace tremie::slump_flow
