#pragma once

// The drag of slender bars (libmpm/boundary/slender_bars.hpp) in a step's problem.

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie::detail {

/// A point of a bar in cell c, with the drag of its piece: as much of it as the cell is full of concrete. In a law that
/// is not Newtonian the viscosity is that at the rate |u|/D.
template <class Geometry>
void add_bar_point(const ImplicitBody<Geometry>& body, const YieldLaw& law, int source, int c,
                   const Index<Geometry::dim>& cell, YieldProblem<Geometry>& problem) {
  constexpr int D = Geometry::dim;
  const auto& grid = problem.grid;
  const BarPoint<D>& bar = body.bars[source];
  PointTerm<D> term;
  term.cell = c, term.source = source;
  term.N = stencil<D>(grid.axes, cell, local_coordinates<D>(grid.axes, cell, bar.x)).N;
  double tau_y = 0.0, mu = 0.0, full = Geometry::measure(bar.x);
  for (int k = 0; k < power(2, D); ++k)
    tau_y += problem.quadrature.yield_of_concrete(c, k) / power(2, D),
        mu += problem.mu_at(c, k) / power(2, D);
  for (const Axis& axis : grid.axes) full *= axis.h;
  term.scale += (bar_drag_along - 1.0) * bar.axis * bar.axis.transpose();
  term.velocity = bar.velocity;
  const double length = bar.length * std::min(1.0, problem.quadrature.V_cell[c] / full);
  term.limit = bar_yield_drag * tau_y * bar.diameter * length;
  term.reach = length / bar.mobility;
  const double rate = slip_velocity(term, grid.cell_nodes, body.v).norm() / bar.diameter;
  term.viscous =
      (mu + viscosity(law, std::clamp(rate, viscosity_scale_rates[0], viscosity_scale_rates[1]), tau_y)) *
      term.reach;
  problem.bars.push_back(term);
}

/// The points of bars that lie in active cells. Their forces go on from those of the last step.
template <class Geometry>
void add_bars(const ImplicitBody<Geometry>& body, const YieldLaw& law, YieldProblem<Geometry>& problem) {
  constexpr int D = Geometry::dim;
  for (std::size_t k = 0; k < body.bars.size(); ++k) {
    const Index<D> cell = cell_of<D>(problem.grid.axes, body.bars[k].x);
    if (const int c = problem.grid.cell_map.at(cell); c >= 0)
      add_bar_point(body, law, static_cast<int>(k), c, cell, problem);
  }
  std::vector<int> last(body.bars.size(), -1);
  for (std::size_t i = 0; i < body.bar_drag.size(); ++i)
    if (const int source = body.bar_drag[i].source; source < static_cast<int>(last.size()))
      last[source] = static_cast<int>(i);
  for (PointTerm<D>& term : problem.bars)
    if (const int i = last[term.source]; i >= 0) {
      term.force = body.bar_drag[i].force, term.slip = body.bar_drag[i].slip;
      project_force(term);
    }
}

}  // namespace tremie::detail
