#include "apparatus/parts/cone/spread.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace tremie::cone {
namespace {

/// A point belongs to the outline when this many others are less than half a cell behind it; fewer are
/// strays.
constexpr std::size_t min_neighbours = 3;

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

/// How far out the concrete reaches by these points: the outermost value that has company, plus half the size
/// of its point. Empty where none has.
std::optional<double> reach_of(std::vector<Weighted>& out, double cell) {
  // Few are strays, so that a look at the outermost is nearly always enough.
  for (std::size_t n = std::min<std::size_t>(out.size(), 32); n > min_neighbours; n = out.size()) {
    std::partial_sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(n), out.end(),
                      [](const Weighted& a, const Weighted& b) { return a.value > b.value; });
    std::size_t i = 0;
    while (i + min_neighbours < n && out[i].value - out[i + min_neighbours].value > 0.5 * cell) ++i;
    if (i + min_neighbours < n) return out[i].value + 0.5 * out[i].size;
    if (n == out.size()) break;
  }
  return std::nullopt;
}

/// A point on the outline, or near it, from the axis [m].
template <int D>
struct Outer {
  Vec<D - 1> at;
  double size;
};
template <int D>
std::vector<Outer<D>> points_beyond(const Points<D>& points, double reach) {
  std::vector<Outer<D>> outer;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (reach < 0.0 || squared_radius(points.x[p]) > reach * reach)
      outer.push_back({points.x[p].template head<D - 1>(), section_size(points, p)});
  return outer;
}

/// Twice the mean of what `reaches(outer, least)` finds, from points that lie within a cell of the outermost
/// one; where one direction has none with company there, within four, and so on. Beyond `least` all are
/// known.
template <int D, class Reaches>
double outline(const Points<D>& points, double cell, Reaches reaches) {
  const double farthest = outermost_radius(points);
  for (double depth = cell;; depth *= 4.0) {
    const double least = farthest - depth;
    if (const std::optional<double> mean = reaches(points_beyond(points, least), least)) return 2.0 * *mean;
    if (!(least > 0.0)) return 2.0 * farthest;  // nothing but strays
  }
}

/// Directions over the full turn; opposite ones make a diameter. Points stand in rows: by 16 directions the
/// outline of one body, turned, would differ by two millimetres (docs/archive/three_d.md).
constexpr int turn = 64;

/// Mean of the reaches beyond `least` in all directions; a quarter has some of its own. Empty where one
/// direction has no point with company there.
std::optional<double> mean_reach(const std::vector<Outer<3>>& outer, double least, double cell,
                                 bool quarter) {
  const int directions = quarter ? turn / 4 : turn, images = quarter ? 4 : 1;
  double sum = 0.0;
  std::vector<Weighted> out;
  for (int k = 0; k < directions; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / turn;
    const double ex = std::cos(angle), ey = std::sin(angle);
    out.clear();
    for (const Outer<3>& point : outer)
      for (int image = 0; image < images; ++image) {
        const double x = image & 1 ? -point.at[0] : point.at[0];
        const double y = image & 2 ? -point.at[1] : point.at[1];
        if (const double a = ex * x + ey * y; a > least) out.push_back({a, 0.0, point.size});
      }
    const std::optional<double> reach = reach_of(out, cell);
    if (!reach) return std::nullopt;
    sum += *reach;
  }
  return sum / directions;
}

template <int D>
double height_within(const Points<D>& points, double reach) {
  std::vector<Weighted> heights;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (squared_radius(points.x[p]) < reach * reach)
      heights.push_back({points.x[p][D - 1], points.volume(p), section_size(points, p)});
  return upper_quantile(heights, 1e-2);
}

template <int D>
double mean_distance_of(const Points<D>& points) {
  double sum = 0.0, mass = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p)
    sum += points.mass[p] * std::sqrt(squared_radius(points.x[p])), mass += points.mass[p];
  return mass > 0.0 ? sum / mass : 0.0;
}

}  // namespace

double mean_distance(const Points<2>& points) { return mean_distance_of(points); }
double mean_distance(const Points<3>& points) { return mean_distance_of(points); }

double spread_of_outermost_point(const Points<2>& points) { return 2.0 * outermost_radius(points); }
double spread_of_outermost_point(const Points<3>& points) { return 2.0 * outermost_radius(points); }

double spread(const Points<2>& points, double cell) {
  return outline<2>(points, cell, [cell](const std::vector<Outer<2>>& outer, double) {
    std::vector<Weighted> radii;
    for (const Outer<2>& point : outer) radii.push_back({point.at[0], 0.0, point.size});
    return reach_of(radii, cell);
  });
}

double spread(const Points<3>& points, double cell, bool quarter) {
  return outline<3>(points, cell, [=](const std::vector<Outer<3>>& outer, double least) {
    return mean_reach(outer, std::max(least, 0.0), cell, quarter);
  });
}

double centre_height(const Points<2>& points, double reach) { return height_within(points, reach); }
double centre_height(const Points<3>& points, double reach) { return height_within(points, reach); }

}  // namespace tremie::cone
