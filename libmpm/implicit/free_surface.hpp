#pragma once

// The head that a free surface gains or loses by its own motion in a step.
//
// A step finds its velocities with gravity where the concrete is at its start. A surface that sinks by dt v
// loses the head rho g dt v within the step; left out, a long step carries a viscous fluid past its level,
// and the next one back further: waves that never die, however viscous it is, as soon as dt exceeds about 10
// mu/(rho g H). With the surface where the step leaves it,
//
//   1/2 rho g dt int_surface v_up^2 dx
//
// joins the step's energy (the free-surface stabilisation of Kaus, Muehlhaus and May 2010, fully implicit):
// levelling is then stable for every step.

#include "libmpm/implicit/state.hpp"

namespace tremie::detail {

/// Where the surface of a column of cells is taken, in shares of a cell across: twice in a section, once in space, where
/// each point costs a good deal.
template <int D>
std::vector<Vec<D>> places_across() {
  if constexpr (D == 2)
    return {quadrature_point<D>(0), quadrature_point<D>(power(2, D) - 1)};
  else
    return {Vec<D>::Constant(0.5)};
}

/// Surface of what stands on the floor (the lowest cells): from there up, where a cell is less than half full. What hangs on
/// a wall higher up has none, nor what stands below a block.
template <class Geometry>
std::vector<PointTerm<Geometry::dim>> surface_of_pool(const ImplicitBody<Geometry>& body, double dt) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  const std::vector<Vec<D>> places = places_across<D>();
  std::vector<PointTerm<D>> surface;
  const auto& grid = body.grid;
  double cell = 1.0;
  for (const auto& axis : grid.axes) cell *= axis.h;
  const double area = cell / (grid.axes[up].h * static_cast<double>(places.size()));
  const auto measure = [&](int c, const Vec<D>& s) {
    return Geometry::measure(position_in_cell<D>(grid.axes, grid.cell_index[c], s));
  };
  const auto fill = [&](int c) {
    return body.quadrature.V_cell[c] / (cell * measure(c, Vec<D>::Constant(0.5)));
  };
  for (int c = 0; c < grid.n_cells(); ++c) {
    Index<D> at = grid.cell_index[c];
    if (at[up] != 0) continue;
    int top = c;
    while (fill(top) >= 0.5) {
      ++at[up];
      const int next = grid.cell_map.at(at);
      if (next < 0) break;
      top = next;
    }
    if (block_of_cell<D>(grid, at)) continue;
    for (const Vec<D>& across : places) {
      Vec<D> s = across;
      s[up] = std::min(1.0, fill(top));
      PointTerm<D> point;
      point.cell = top;
      point.N = stencil<D>(grid.axes, grid.cell_index[top], s).N;
      point.penalty(up, up) = -body.mix.density * body.gravity[up] * area * measure(top, s) * dt;
      surface.push_back(point);
    }
  }
  return surface;
}

}  // namespace tremie::detail
