#pragma once

// Keeps the points where the concrete is.
//
// ln J keeps account of the volume that the flow gives each point, but nothing ties it to where the points
// are: under a rolling front they enter the cells above the floor from the side and never settle, half a cell
// stays empty for good, and the rest of the body is overfull by as much. The body then stands on a cushion:
// too tall, too heavy, and its spread a few percent too large. Here the points are moved, by the smallest
// displacement u (in the mass norm) whose divergence takes cells inside the body back to full,
//
//   minimise  1/2 sum_i m_i |u_i|^2 + kappa/2 sum_c V_c (div u - e_c)^2,     e_c = share_c (fill_c - 1),
//
// never faster than the flow deforms the cell: a body at rest is left alone.

#include "libmpm/implicit/problem/yield_problem.hpp"

namespace tremie {

struct ParticleShifting {
  bool on =
      false;  ///< for bodies that flow far; it keeps mass and momentum, angular momentum only to about 1e-6
  double rate = 1.0;  ///< share of a cell's misfill that is mended per unit of shear
  /// For flows of thousands of steps, which stray points would spoil. Cells sheared by less than this share of the mean rate keep
  /// their points where they are. And a point counts for all the cells that a box of its volume reaches into, so that rows of
  /// points that pass by do not fill and empty them. 0: neither.
  double rigid_share = 0.0;
};

/// kappa, in density times area of a cell.
inline constexpr double fill_stiffness = 100.0;

/// What the minimum has of each cell: kappa V_c (0: the cell is left alone) and e_c; whether it is as good as rigid.
struct CellFill {
  std::vector<double> stiffness, misfill;
  std::vector<char> rigid;  ///< empty where ParticleShifting::rigid_share is 0
};

namespace detail {

/// Shares of a box of width `wide` [cells] about the local coordinate s that lie in the cell before, in the cell and behind it.
inline std::array<double, 3> shares_of_box(double s, double wide) {
  const double low = std::clamp(0.5 - s / wide, 0.0, 1.0),
               high = std::clamp(0.5 - (1.0 - s) / wide, 0.0, 1.0);
  return {low, 1.0 - low - high, high};
}

}  // namespace detail

/// Volume that the points have in every cell, each spread over a box of its volume in the cell's proportions. What would lie
/// beyond a wall or the surface stays in the point's cell.
template <class Geometry>
std::vector<double> volumes_by_boxes(const ActiveGrid<Geometry::dim>& grid,
                                     const Points<Geometry::dim>& points) {
  constexpr int D = Geometry::dim;
  std::vector<double> filled(grid.cell_index.size(), 0.0);
  double cell = 1.0;
  for (const Axis& a : grid.axes) cell *= a.h;
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
      const int p = grid.order[i];
      const double V = points.volume(p), full = cell * Geometry::measure(points.x[p]),
                   wide = std::min(1.0, std::pow(V / full, 1.0 / D));
      const Vec<D> s = local_coordinates<D>(grid.axes, grid.cell_index[c], points.x[p]);
      std::array<std::array<double, 3>, D> share;
      for (int d = 0; d < D; ++d) share[d] = detail::shares_of_box(s[d], wide);
      for (int k = 0; k < power(3, D); ++k) {
        const Index<D> o = local_offset<D>(k);
        Index<D> n;
        double part = V;
        for (int d = 0; d < D; ++d)
          n[d] = grid.axes[d].cell(grid.cell_index[c][d] + o[d] - 1), part *= share[d][o[d]];
        if (part == 0.0) continue;
        const int to = grid.cell_map.at(n);
        filled[to >= 0 ? to : c] += part;
      }
    }
  return filled;
}

/// Whether each cell is sheared by less than a share of the mean rate.
inline std::vector<char> rigid_cells(const std::vector<double>& gamma_dot, double share) {
  double mean = 0.0;
  for (const double rate : gamma_dot) mean += rate / static_cast<double>(gamma_dot.size());
  std::vector<char> rigid(gamma_dot.size());
  for (std::size_t c = 0; c < rigid.size(); ++c) rigid[c] = gamma_dot[c] <= share * mean;
  return rigid;
}

/// `gamma_dot`: mean shear rate of every cell [1/s].
template <class Geometry>
CellFill cell_fill(const YieldProblem<Geometry>& problem, const Points<Geometry::dim>& points,
                   const std::vector<double>& gamma_dot, const ParticleShifting& settings) {
  constexpr int D = Geometry::dim;
  const auto& grid = problem.grid;
  double part = 1.0, reach2 = 0.0;
  for (const Axis& a : grid.axes) part *= 0.5 * a.h, reach2 = std::max(reach2, a.h * a.h);
  const bool boxes = settings.rigid_share > 0.0;
  CellFill cells{std::vector<double>(gamma_dot.size(), 0.0), std::vector<double>(gamma_dot.size(), 0.0),
                 boxes ? rigid_cells(gamma_dot, settings.rigid_share) : std::vector<char>{}};
  const std::vector<double> filled = boxes ? volumes_by_boxes<Geometry>(grid, points) : std::vector<double>{};
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    if (boxes && cells.rigid[c]) continue;
    double full = 0.0, mass = 0.0, volume = 0.0;
    for (int k = 0; k < power(2, D); ++k)
      full += part *
              Geometry::measure(position_in_cell<D>(grid.axes, grid.cell_index[c], quadrature_point<D>(k)));
    for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
      mass += points.mass[grid.order[i]];
      volume += points.volume(grid.order[i]);
    }
    const double misfill = (boxes ? filled[c] : volume) / full - 1.0;
    if (misfill <= 0.0 && !is_inside<D>(grid, grid.cell_index[c])) continue;
    cells.misfill[c] = misfill * -std::expm1(-settings.rate * gamma_dot[c] * problem.dt);
    cells.stiffness[c] = fill_stiffness * reach2 * mass / volume * full;
  }
  return cells;
}

/// The components that walls hold back, and all of what is behind a plane of symmetry.
template <int D>
std::vector<char> held_by_walls(const ActiveGrid<D>& grid) {
  std::vector<char> fixed(grid.node_index.size() * D, 0);
  for (int i = 0; i < grid.n_nodes(); ++i) {
    const bool in_block = !grid.blocks.empty() && block_of_node<D>(grid, grid.node_index[i]);
    const Sheet<D>* sheet = sheet_at_node<D>(grid, grid.node_index[i]);
    for (int d = 0; d < D; ++d)
      fixed[i * D + d] = in_block || (sheet && d == sheet->normal) ||
                         grid.axes[d].on_low_wall(grid.node_index[i][d]) ||
                         grid.axes[d].on_high_wall(grid.node_index[i][d]);
  }
  for (const MirrorNode<D>& m : grid.mirrors) std::fill_n(&fixed[m.node * D], D, 1);
  return fixed;
}

/// Besides these, all nodes that a rigid cell sees: a plug is not stirred by what is sheared beside it.
template <int D>
std::vector<char> held_nodes(const ActiveGrid<D>& grid, const CellFill& cells) {
  std::vector<char> fixed = held_by_walls<D>(grid);
  for (std::size_t c = 0; c < cells.rigid.size(); ++c)
    if (cells.rigid[c])
      for (const int i : grid.cell_nodes[c]) std::fill_n(&fixed[i * D], D, 1);
  return fixed;
}

/// Forces of the misfill on the nodes.
template <class Geometry>
Eigen::VectorXd fill_forces(const YieldProblem<Geometry>& problem, const CellFill& cells,
                            const std::vector<char>& fixed) {
  constexpr int D = Geometry::dim;
  const auto& grid = problem.grid;
  Eigen::VectorXd R = Eigen::VectorXd::Zero(grid.n_nodes() * D);
  for (int c = 0; c < grid.n_cells(); ++c) {
    const auto& b = problem.quadrature.divergence_rows(c);
    for (int i = 0; i < power(3, D); ++i)
      R.segment<D>(grid.cell_nodes[c][i] * D) += cells.stiffness[c] * cells.misfill[c] * b[i];
  }
  fold_mirrors<D>(grid, R);
  mask(fixed, R);
  return R;
}

/// Nodal displacements [m] that even out the fill of the cells over a step.
template <class Geometry>
std::vector<Vec<Geometry::dim>> shifting_displacement(const YieldProblem<Geometry>& problem,
                                                      const CellFill& cells,
                                                      BlockSystem<Geometry::dim>& system) {
  constexpr int D = Geometry::dim, n_local = power(3, D), n_dof = n_local * D;
  const auto& grid = problem.grid;
  const std::vector<char> fixed = held_nodes<D>(grid, cells);
  const Eigen::VectorXd R = fill_forces(problem, cells, fixed);
  system.set_pattern(grid);
  system.set_zero();
  for (int c = 0; c < grid.n_cells(); ++c) {
    if (cells.stiffness[c] == 0.0) continue;
    Vec<n_dof> b;
    const auto& rows = problem.quadrature.divergence_rows(c);
    for (int i = 0; i < n_local; ++i) b.template segment<D>(i * D) = rows[i];
    system.add_cell(c, cells.stiffness[c] * b * b.transpose());
  }
  for (int i = 0; i < grid.n_nodes(); ++i)
    for (int d = 0; d < D; ++d) system.add_diagonal(i, d, problem.nodes.mass[i]);
  // Walls inside the grid let nothing through here either.
  std::vector<PointTerm<D>> bound = problem.bound;
  for (PointTerm<D>& t : bound) t.penalty *= problem.dt;
  add_penalty_stiffness<D>(bound, system);
  system.fix(fixed);
  std::vector<Vec<D>> displacement(grid.node_index.size(), Vec<D>::Zero());
  if (!system.factorise()) return displacement;
  const Eigen::VectorXd solution = system.solve(R);
  for (int i = 0; i < grid.n_nodes(); ++i) displacement[i] = solution.segment<D>(i * D);
  fill_mirrors<D>(grid, displacement);
  return displacement;
}

namespace detail {

/// Value of a nodal field in cell c, of which u are the nodes, at the local coordinates s.
template <int D>
Vec<D> value_at(const ActiveGrid<D>& grid, int c, const std::array<Vec<D>, power(3, D)>& u, const Vec<D>& s) {
  const Stencil<D> st = stencil<D>(grid.axes, grid.cell_index[c], s);
  Vec<D> value = Vec<D>::Zero();
  for (int k = 0; k < power(3, D); ++k) value += st.N[k] * u[k];
  return value;
}
inline Vec<3> value_at(const ActiveGrid<3>& grid, int c, const CellQuads& u, const Vec<3>& s) {
  std::array<std::array<double, 3>, 3> N;
  for (int d = 0; d < 3; ++d) N[d] = splines(grid.axes[d], grid.cell_index[c][d], s[d]).N;
  f64x4 value = {};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const f64x4* line = &u[9 * i + 3 * j];
      value += N[0][i] * N[1][j] * (N[2][0] * line[0] + N[2][1] * line[1] + N[2][2] * line[2]);
    }
  return to_vec(value);
}

}  // namespace detail

/// Moves the points by the displacements u; their velocities follow the field they move in.
template <int D, class Move = StraightAhead>
void shift_points(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& u, Points<D>& points,
                  const Move& motion = {}) {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const auto of_cell = detail::at_controls(grid, u, c);
    for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
      const int p = grid.order[i];
      // The point may have left its cell by now; beyond it the cell's polynomials run away with the square of
      // the distance.
      const Vec<D> s =
          local_coordinates<D>(grid.axes, grid.cell_index[c], points.x[p]).cwiseMax(0.0).cwiseMin(1.0);
      const Vec<D> shift = detail::value_at(grid, c, of_cell, s);
      points.v[p] += points.C[p] * shift;
      const Vec<D> from = points.x[p];
      motion.shift(points, p, shift);
      keep_in_domain<D>(grid, from, points.x[p]);
    }
  }
}

}  // namespace tremie
