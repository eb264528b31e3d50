#pragma once

// Where the stresses of a partly filled cell are integrated: at the two-point Gauss rule of what its points
// fill, mean and standard deviation of their places each way.
//
// With the quadrature points of a full cell, a film on a wall that is thinner than a cell has all its volume at the
// places next to the wall. They leave the film a motion that does not strain there, so it slides off without
// friction. The fitted rule has the volume, the centre and the spread of the concrete: a thin film holds and
// drains as the quadratic splines of its cell let it.

#include <algorithm>
#include <array>
#include <cmath>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// Local coordinates of the fitted quadrature points of cell c; bit d of k set means the upper one in direction d.
template <class Geometry>
std::array<Vec<Geometry::dim>, power(2, Geometry::dim)> cut_cell_rule(const ActiveGrid<Geometry::dim>& grid,
                                                                      const Points<Geometry::dim>& points,
                                                                      int c) {
  constexpr int D = Geometry::dim;
  double section = 1.0;
  for (const Axis& a : grid.axes) section *= a.h;
  double volume = 0.0, of_a_point = 0.0;
  Vec<D> mean = Vec<D>::Zero(), square = Vec<D>::Zero();
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    const double V = points.volume(p) / Geometry::measure(points.x[p]);
    const Vec<D> s = local_coordinates<D>(grid.axes, grid.cell_index[c], points.x[p]);
    volume += V;
    mean += V * s;
    square += V * s.cwiseAbs2();
    of_a_point += V * std::pow(V / section, 2.0 / D) / 12.0;  // a point fills a cube around its place
  }
  mean /= volume;
  const Vec<D> variance = square / volume - mean.cwiseAbs2() + Vec<D>::Constant(of_a_point / volume);
  std::array<Vec<D>, power(2, D)> place;
  for (int k = 0; k < power(2, D); ++k)
    for (int d = 0; d < D; ++d) {
      const double sigma = std::sqrt(std::max(1e-8, variance[d]));
      place[k][d] = std::clamp(mean[d] + ((k >> d) & 1 ? sigma : -sigma), 0.0, 1.0);
    }
  return place;
}

}  // namespace tremie
