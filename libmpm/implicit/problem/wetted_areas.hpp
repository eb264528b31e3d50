#pragma once

// The area of a flat wall that is wetted, shared among the nodes on it by their splines: what a wall law that holds with a
// stress acts on. Concrete in a cell at a wall lies on the wall: it wets it where the half of the cell next to it is full.

#include <algorithm>
#include <array>
#include <vector>

#include "libmpm/implicit/problem/quadrature.hpp"

namespace tremie {

/// By node: the area of the wall across each axis [m^2].
template <int D>
using NodeAreas = std::vector<std::array<double, D>>;

namespace detail {

/// Adds what cell c wets of its low or high face across axis a, where the wall stands: stands(x).
template <class Geometry, class Stands>
void add_wetted_face(const ActiveGrid<Geometry::dim>& grid, const Quadrature<Geometry>& quadrature, int c,
                     int a, bool high, NodeAreas<Geometry::dim>& areas, Stands stands) {
  constexpr int D = Geometry::dim;
  const Index<D>& cell = grid.cell_index[c];
  double face = 1.0;  // of a quadrature point
  for (int d = 0; d < D; ++d) face *= d == a ? 1.0 : 0.5 * grid.axes[d].h;
  for (int k = 0; k < power(2, D); ++k) {
    if (((k >> a) & 1) != (high ? 1 : 0)) continue;
    Vec<D> s = quadrature_point<D>(k);
    s[a] = high ? 1.0 : 0.0;
    const Vec<D> x = position_in_cell<D>(grid.axes, cell, s);
    if (!stands(x)) continue;
    const double measure = Geometry::measure(x);
    const double half = 0.5 * grid.axes[a].h * face * measure;
    const double wet = std::min(1.0, (quadrature.V[c][k] + quadrature.V[c][k ^ (1 << a)]) / half);
    const Stencil<D> st = stencil<D>(grid.axes, cell, s);
    for (int i = 0; i < power(3, D); ++i) areas[grid.cell_nodes[c][i]][a] += wet * face * measure * st.N[i];
  }
}

}  // namespace detail

/// Of the walls of FaceKind::wall_law at the ends of the axes, and of both sides of such sheets.
template <class Geometry>
NodeAreas<Geometry::dim> wetted_areas(const ActiveGrid<Geometry::dim>& grid,
                                      const Quadrature<Geometry>& quadrature) {
  constexpr int D = Geometry::dim;
  NodeAreas<D> areas(grid.node_index.size(), std::array<double, D>{});
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int a = 0; a < D; ++a) {
      const Axis& axis = grid.axes[a];
      const int at = grid.cell_index[c][a];
      const auto everywhere = [](const Vec<D>&) { return true; };
      if (axis.low == FaceKind::wall_law && at == 0)
        detail::add_wetted_face(grid, quadrature, c, a, false, areas, everywhere);
      if (axis.high == FaceKind::wall_law && at == axis.n_cells - 1)
        detail::add_wetted_face(grid, quadrature, c, a, true, areas, everywhere);
      for (const Sheet<D>& s : grid.sheets) {
        if (s.normal != a || s.contact != FaceKind::wall_law || (at != s.face && at + 1 != s.face)) continue;
        detail::add_wetted_face(grid, quadrature, c, a, at != s.face, areas,
                                [&](const Vec<D>& x) { return x[s.along] >= s.from && x[s.along] < s.to; });
      }
    }
  for (const MirrorNode<D>& m : grid.mirrors)
    for (int a = 0; a < D; ++a) areas[m.of][a] += areas[m.node][a];
  return areas;
}

}  // namespace tremie
