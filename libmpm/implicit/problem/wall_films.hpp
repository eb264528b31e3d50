#pragma once

// Films on upright walls in 3D, where the quadrature points of a cell stay where they are.
//
// A film is thinner than a cell. With all its volume at the quadrature points next to the wall it has a motion that does not
// strain there, and slides off without friction, however thin it is. So a part of it counts at the points farther away. That
// motion strains there by some 2.7/(0.5 s) of the film's mean speed over a cell, s the film's share of the cell: a film of
// tau_0/(rho g), which the yield stress just holds, needs 0.19 of its volume there where it fills little of the cell.

#include <algorithm>
#include <array>
#include <numeric>

#include "libmpm/grid/active_grid.hpp"

namespace tremie {

/// Least share of the volume at the quadrature points away from the wall, in a cell that is hardly filled; and the fill of a cell
/// from which a film reaches them by itself.
inline constexpr double film_share = 0.3, thick_film = 0.4;

/// Moves volume of a partly filled cell away from the upright walls that hold it. `V`: of its quadrature points [m^3].
inline void hold_film(const ActiveGrid<3>& grid, const Index<3>& cell, std::array<double, 8>& V) {
  double full = 1.0;
  for (const Axis& a : grid.axes) full *= a.h;
  const double least = film_share * (1.0 - std::accumulate(V.begin(), V.end(), 0.0) / full / thick_film);
  if (least <= 0.0) return;
  const auto holds = [](FaceKind face) { return face == FaceKind::no_slip || face == FaceKind::wall_law; };
  for (int d = 0; d < 2; ++d) {
    const Axis& a = grid.axes[d];
    const int c = cell[d], upper = 1 << d;
    const bool below = (c == 0 && holds(a.low)) || a.repeated(c),
               above = (c == a.n_cells - 1 && holds(a.high)) || a.repeated(c + 1);
    if (below == above) continue;
    for (int k = 0; k < 8; ++k) {
      if (k & upper) continue;
      double &far = V[below ? k | upper : k], &near = V[below ? k : k | upper];
      const double all = near + far;
      far = std::max(far, least * all), near = all - far;
    }
  }
}

}  // namespace tremie
