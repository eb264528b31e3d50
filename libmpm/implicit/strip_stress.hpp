#pragma once

// The stress of a wall law along strips of a wall inside the grid (libmpm/boundary/wall_strips.hpp) in a step's problem. The
// terms stand among those of bars, which yield in the same way.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "libmpm/boundary/wall_law.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie::detail {

/// What is left of the slip across a strip: the solvers ask for the inverse of S.
inline constexpr double across_a_strip = 1e-3;

/// Share of a strip that is wetted: all where the concrete half a cell before it fills its cell by half.
template <class Geometry>
double wetted_share(const WallStrip<Geometry::dim>& strip, const YieldProblem<Geometry>& problem) {
  constexpr int D = Geometry::dim;
  const auto& grid = problem.grid;
  Vec<D> before = strip.x;
  for (int d = 0; d < D; ++d) before[d] += 0.5 * grid.axes[d].h * strip.normal[d];
  const Index<D> cell = cell_of<D>(grid.axes, before);
  const int c = grid.cell_map.at(cell);
  if (c < 0) return 0.0;
  double full = Geometry::measure(position_in_cell<D>(grid.axes, cell, Vec<D>(Vec<D>::Constant(0.5))));
  for (const Axis& axis : grid.axes) full *= axis.h;
  return std::min(1.0, 2.0 * problem.quadrature.V_cell[c] / full);
}

/// Terms of the strips that lie in active cells; their forces go on from those of the last step. `first`: number of the first
/// strip among the sources of the terms of bars.
template <class Geometry>
void add_strips(const ImplicitBody<Geometry>& body, const WallStress& stress, int first,
                YieldProblem<Geometry>& problem) {
  constexpr int D = Geometry::dim;
  const auto& grid = problem.grid;
  std::vector<const PointTerm<D>*> last(body.strips.size(), nullptr);
  for (const PointTerm<D>& before : body.bar_drag)
    if (before.source >= first && before.source - first < static_cast<int>(last.size()))
      last[before.source - first] = &before;
  for (std::size_t k = 0; k < body.strips.size(); ++k) {
    const WallStrip<D>& strip = body.strips[k];
    const Index<D> cell = cell_of<D>(grid.axes, strip.x);
    const int c = grid.cell_map.at(cell);
    if (c < 0) continue;
    PointTerm<D> term;
    term.cell = c, term.source = first + static_cast<int>(k);
    term.N = stencil<D>(grid.axes, cell, local_coordinates<D>(grid.axes, cell, strip.x)).N;
    term.scale -= (1.0 - across_a_strip) * strip.normal * strip.normal.transpose();
    term.velocity = term.target = strip.velocity;
    const double area = strip.area * wetted_share(strip, problem);
    term.limit = stress.yield * area;
    term.viscous = stress.viscous * area;
    term.reach = area / grid.cell_size_min();
    if (last[k]) {
      term.force = last[k]->force, term.slip = last[k]->slip;
      project_force(term);
    }
    problem.bars.push_back(term);
  }
}

}  // namespace tremie::detail
