#include "apparatus/parts/funnel/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "libmpm/constitutive/equation_of_state.hpp"

namespace tremie::funnel {
namespace {

double slant(const Part& part) { return std::hypot(part.to - part.from, part.half_high - part.half_low); }

/// From the wall into the concrete.
Vec<2> normal(const Part& part) {
  return Vec<2>(part.from - part.to, part.half_high - part.half_low) / slant(part);
}

double half_width(const Part& part, double z) {
  return part.half_low + (part.half_high - part.half_low) * (z - part.from) / (part.to - part.from);
}

/// Half of the width that a body between two heights would have all along, for its volume.
double mean_half_width(double low, double high, bool round) {
  return round ? std::sqrt((low * low + low * high + high * high) / 3.0) : 0.5 * (low + high);
}

const Part& part_at(const std::vector<Part>& parts, double z) {
  const auto at = std::find_if(parts.begin(), parts.end(), [z](const Part& p) { return z <= p.to; });
  return at == parts.end() ? parts.back() : *at;
}

}  // namespace

std::vector<Part> parts_of(const Shape& shape) {
  const double low = 0.5 * shape.mouth, high = 0.5 * shape.top, bend = shape.throat + shape.taper;
  std::vector<Part> parts{
      {0.0, shape.throat, low, low}, {shape.throat, bend, low, high}, {bend, height(shape), high, high}};
  std::erase_if(parts, [](const Part& p) { return !(p.to > p.from); });
  return parts;
}

double half_width(const Shape& shape, double z) { return half_width(part_at(parts_of(shape), z), z); }

double volume(const Shape& shape) {
  double sum = 0.0;
  for (const Part& p : parts_of(shape)) {
    const double half = mean_half_width(p.half_low, p.half_high, shape.depth == 0.0);
    sum += (p.to - p.from) * (shape.depth == 0.0 ? std::numbers::pi * half * half : 2.0 * half * shape.depth);
  }
  return sum;
}

void fill(const Shape& shape, const Mix& mix, double g, double dx, double dz, Points<2>& points) {
  const bool round = shape.depth == 0.0;
  for (const Part& part : parts_of(shape)) {
    const int rows = std::max(1, static_cast<int>(std::lround((part.to - part.from) / dz)));
    const double row = (part.to - part.from) / rows;
    for (int j = 0; j < rows; ++j) {
      const double foot = part.from + j * row, z = foot + 0.5 * row;
      const double half = mean_half_width(half_width(part, foot), half_width(part, foot + row), round);
      const double ln_J = ln_J_under(mix.density * g * (height(shape) - z), mix.K);
      const int n = std::max(1, static_cast<int>(std::lround(half / dx)));
      for (int i = 0; i < n; ++i) {
        const double inner = half * i / n, outer = half * (i + 1) / n;
        const double V = row * (round ? std::numbers::pi * (outer * outer - inner * inner) : outer - inner);
        add_point<2>(points, {0.5 * (inner + outer), z}, mix.density * V, V * std::exp(-ln_J), ln_J);
      }
    }
  }
}

std::vector<WallStrip<2>> wall_strips(const Shape& shape, double spacing) {
  std::vector<WallStrip<2>> strips;
  for (const Part& part : parts_of(shape)) {
    const int n = std::max(1, static_cast<int>(std::ceil(slant(part) / spacing)));
    for (int i = 0; i < n; ++i) {
      const double z = part.from + (i + 0.5) / n * (part.to - part.from);
      WallStrip<2> strip;
      strip.normal = normal(part);
      // A hair inside: on a face of the grid it would lie in the cell behind the wall.
      strip.x = Vec<2>(half_width(part, z), z) + 1e-9 * shape.mouth * strip.normal;
      strip.area =
          slant(part) / n * (shape.depth == 0.0 ? 2.0 * std::numbers::pi * half_width(part, z) : 1.0);
      strips.push_back(strip);
    }
  }
  return strips;
}

std::vector<BoundaryPoint<2>> wall_points(const Shape& shape, double spacing, bool slips) {
  std::vector<BoundaryPoint<2>> points;
  for (const WallStrip<2>& strip : wall_strips(shape, spacing)) {
    BoundaryPoint<2> point;
    point.x = strip.x;
    if (slips) point.normal = strip.normal;
    points.push_back(point);
  }
  return points;
}

RigidWall<2> wall_of(const Shape& shape, double reach) {
  return [parts = parts_of(shape), reach](const Vec<2>& x, double) -> std::optional<WallView<2>> {
    if (x[1] < 0.0 || x[1] > parts.back().to) return std::nullopt;
    const Part& part = part_at(parts, x[1]);
    const Vec<2> n = normal(part);
    const double gap = n.dot(x - Vec<2>(half_width(part, x[1]), x[1]));
    if (gap > reach) return std::nullopt;
    return WallView<2>{gap, n, Vec<2>(0.0, 0.0)};
  };
}

}  // namespace tremie::funnel
