#pragma once

// What a point in 3D has to do with the 27 nodes of its cell, one direction at a time: a third of the
// operations of 27 products, and four components side by side.

#include <array>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie::detail {

/// A vector of three and one more.
inline f64x4 to_quad(const Vec<3>& v, double last = 0.0) { return f64x4{v[0], v[1], v[2], last}; }
inline Vec<3> to_vec(const f64x4& q) { return Vec<3>(q[0], q[1], q[2]); }

using CellQuads = std::array<f64x4, 27>;

/// Values of the three splines in each direction, and what takes their place for the slope in that direction.
struct SpaceWeights {
  double N[3][3], slope[3][3];
};

/// Sum over the nodes of N u, and of the same with the slope's weights in direction d.
inline void contract(const CellQuads& u, const SpaceWeights& w, f64x4& value, std::array<f64x4, 3>& slope) {
  const auto &x = w.N[0], &y = w.N[1], &z = w.N[2];
  const auto &dx = w.slope[0], &dy = w.slope[1], &dz = w.slope[2];
  value = f64x4{};
  slope.fill(f64x4{});
  for (int i = 0; i < 3; ++i) {
    f64x4 plane = {}, plane_y = {}, plane_z = {};
    for (int j = 0; j < 3; ++j) {
      const f64x4* a = &u[9 * i + 3 * j];
      const f64x4 line = z[0] * a[0] + z[1] * a[1] + z[2] * a[2];
      plane += y[j] * line;
      plane_y += dy[j] * line;
      plane_z += y[j] * (dz[0] * a[0] + dz[1] * a[1] + dz[2] * a[2]);
    }
    value += x[i] * plane;
    slope[0] += dx[i] * plane;
    slope[1] += x[i] * plane_y;
    slope[2] += x[i] * plane_z;
  }
}

/// The adjoint of contract(), added to the nodes.
inline void spread(const SpaceWeights& w, const f64x4& value, const std::array<f64x4, 3>& slope,
                   CellQuads& u) {
  const auto &x = w.N[0], &y = w.N[1], &z = w.N[2];
  const auto &dx = w.slope[0], &dy = w.slope[1], &dz = w.slope[2];
  for (int i = 0; i < 3; ++i) {
    const f64x4 plane = x[i] * value + dx[i] * slope[0], plane_y = x[i] * slope[1], plane_z = x[i] * slope[2];
    for (int j = 0; j < 3; ++j) {
      const f64x4 line = y[j] * plane + dy[j] * plane_y, line_z = y[j] * plane_z;
      for (int k = 0; k < 3; ++k) u[9 * i + 3 * j + k] += z[k] * line + dz[k] * line_z;
    }
  }
}

inline CellQuads of_cell(const ActiveGrid<3>& grid, const std::vector<Vec<3>>& v, int c) {
  CellQuads at_nodes;
  for (std::size_t k = 0; k < 27; ++k) at_nodes[k] = to_quad(v[grid.cell_nodes[c][k]]);
  return at_nodes;
}

}  // namespace tremie::detail
