#pragma once

// The mean of a field of the points over a length of the material: what a shear rate is where it breaks down a structure of
// grains (Thixotropy::layer).

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "libmpm/geometry/polar.hpp"
#include "libmpm/grid/active_grid.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie::detail {

/// Square of the distance of two places [m^2]; along a periodic axis that of the nearest images.
template <class Geometry>
double distance_squared(const std::array<Axis, Geometry::dim>& axes, const Vec<Geometry::dim>& x,
                        const Vec<Geometry::dim>& y) {
  Vec<Geometry::dim> d = y - x;
  for (int i = 0; i < Geometry::dim; ++i)
    if (axes[i].periodic) d[i] -= axes[i].length() * std::round(d[i] / axes[i].length());
  if constexpr (std::is_same_v<Geometry, Polar>) {
    const double half = std::sin(0.5 * d[1]);
    return d[0] * d[0] + 4.0 * x[0] * y[0] * half * half;
  } else {
    return d.squaredNorm();
  }
}

/// How many cells of the direction d lie within `layer` of a place, to one side.
template <class Geometry>
int cells_within(const ActiveGrid<Geometry::dim>& grid, const Vec<Geometry::dim>& x, double layer, int d) {
  const Axis& a = grid.axes[d];
  double size = a.h;
  if constexpr (std::is_same_v<Geometry, Polar>)  // narrowest where the grid begins
    if (d == 1) size *= std::max(x[0] - layer, grid.axes[0].origin);
  const int cells = static_cast<int>(std::min(1e6, std::ceil(layer / size)));
  return a.periodic ? std::min(cells, (a.n_cells - 1) / 2) : cells;
}

/// Mean over the points around x, weighted by volume and by 1 - distance/layer. The grid is that of the points' places.
template <class Geometry>
double mean_around(const ActiveGrid<Geometry::dim>& grid, const Points<Geometry::dim>& points,
                   const std::vector<double>& field, double layer, const Vec<Geometry::dim>& x) {
  constexpr int D = Geometry::dim;
  const Index<D> centre = cell_of<D>(grid.axes, x);
  Index<D> reach, offset;
  for (int d = 0; d < D; ++d) offset[d] = -(reach[d] = cells_within<Geometry>(grid, x, layer, d));
  double sum = 0.0, weights = 0.0;
  while (offset[0] <= reach[0]) {
    Index<D> cell;
    for (int d = 0; d < D; ++d) cell[d] = grid.axes[d].cell(centre[d] + offset[d]);
    const int c = grid.cell_map.at(cell);
    for (int i = c < 0 ? 0 : grid.cell_begin[c]; c >= 0 && i < grid.cell_begin[c + 1]; ++i) {
      const int q = grid.order[i];
      const double near = 1.0 - std::sqrt(distance_squared<Geometry>(grid.axes, x, points.x[q])) / layer;
      if (!(near > 0.0)) continue;
      const double weight = near * points.volume(q);
      sum += weight * field[q], weights += weight;
    }
    for (int d = D - 1; d >= 0 && ++offset[d] > reach[d] && d > 0; --d) offset[d] = -reach[d];
  }
  return sum / weights;  // the point itself has a weight
}

/// The field's mean around every point.
template <class Geometry>
std::vector<double> layer_means(const ActiveGrid<Geometry::dim>& grid, const Points<Geometry::dim>& points,
                                const std::vector<double>& field, double layer) {
  std::vector<double> means(points.size());
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < points.size(); ++p)
    means[p] = mean_around<Geometry>(grid, points, field, layer, points.x[p]);
  return means;
}

}  // namespace tremie::detail
