#pragma once

// The convex problem of one backward-Euler step: find the nodal velocities v that minimise
//
//   1/2 (v - v*)' M (v - v*) / dt  +  sum_q V_q [mu/2 gamma_dot^2 + Phi(gamma_dot)]
//     +  sum_c V_c [K dt/2 (div v)^2 - p div v]  +  sum_q V_q zeta/2 (div_q v - div v)^2
//     +  contact  +  wall terms (boundary/wall_term.hpp),
//
// Phi the potential of the yield law, gamma_dot = |q| at quadrature point q, one divergence a cell. A velocity
// that alternates from node to node has none in any cell: nothing but the shear stress resists it, and in a
// fluid with little yield stress it gathers the points on every second face. zeta, a bulk viscosity of what
// differs from the cell's mean, does, in sections and where systems are solved by iteration; of a resolved flow it sees next to nothing. Its stationarity is the
// momentum balance; its solvers are in admm.hpp and newton.hpp.

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "libmpm/boundary/contact.hpp"
#include "libmpm/boundary/node_terms.hpp"
#include "libmpm/boundary/point_terms.hpp"
#include "libmpm/grid/active_grid.hpp"
#include "libmpm/implicit/matrix_free/admm_state.hpp"
#include "libmpm/implicit/problem/quadrature.hpp"
#include "libmpm/linear/block_system.hpp"
#include "libmpm/transfer/apic.hpp"

namespace tremie {

struct Nothing {};

/// Stress of the yield part and, for ADMM, the split strain rate, at every quadrature point of every cell. Kept
/// between steps by cell as a first guess. A body whose systems are solved by iteration keeps them in `packed`
/// instead.
template <class Geometry>
struct AdmmState {
  using Strain = Vec<Geometry::n_strain>;
  static constexpr int n = power(2, Geometry::dim);
  std::vector<std::array<Strain, n>> stress;  ///< [Pa]
  std::vector<std::array<Strain, n>> rate;    ///< [1/s]
  /// What side walls hold of the yield stress (side_walls.hpp); empty: there are none.
  std::vector<std::array<double, n>> wall_share;
  std::conditional_t<Geometry::dim == 3, PackedAdmmState, Nothing> packed;

  /// Of so many cells, without stress.
  void resize(std::size_t cells) {
    std::array<Strain, n> none;
    none.fill(Strain::Zero());
    stress.assign(cells, none), rate.assign(cells, none);
  }
};

template <class Geometry>
struct YieldProblem {
  static constexpr int D = Geometry::dim;
  const ActiveGrid<D>& grid;
  const Quadrature<Geometry>& quadrature;
  const NodalState<D>& nodes;  ///< masses, and v* with gravity already in it
  double dt;
  double mu;                ///< where it is not one everywhere: of the scale of the stresses
  double K;                 ///< of the systems: the mix's, or as much as they can bear (admm_matrix_free.hpp)
  std::vector<char> fixed;  ///< a flag a component: prescribed by a wall
  std::vector<ContactPoint<D>> contact;  ///< moving rigid walls
  std::vector<NodeTerm<D>> wall_nodes;   ///< along flat walls, and between side walls
  std::vector<NodeDrag<D>> drag;         ///< their viscous drag, a node each; empty: none
  std::vector<PointTerm<D>> bound;       ///< walls inside the grid
  std::vector<PointTerm<D>> surface;     ///< head of the moving free surface, in a section
  std::vector<PointTerm<D>> bars;        ///< thinner than the grid resolves; ADMM alone
  double zeta = 0.0;                     ///< [Pa s]; by factors in 3D, none
  std::vector<double> p_offset = {};     ///< of the cells' pressures [Pa]; empty: those before the step
  double K_share = 1.0;                  ///< K over the mix's
  double eta =
      mu;  ///< viscosity that scales stresses: mu, and the law's at the rate of the last step, within viscosity_scale_rates

  /// Pressure of cell c without divergence.
  double offset(int c) const { return p_offset.empty() ? quadrature.p[c] : p_offset[c]; }
  /// Plastic viscosity at quadrature point k of cell c [Pa s].
  double mu_at(int c, int k) const { return quadrature.mu.empty() ? mu : quadrature.mu[c][k]; }
  /// All terms at points, in the order in which they are added up.
  std::array<std::span<const PointTerm<D>>, 3> points() const { return {bound, surface, bars}; }
};

struct SolveReport {
  bool converged = false;
  int iterations = 0;
};

/// Strain-rate vector at quadrature point k of cell c.
template <class Geometry>
Vec<Geometry::n_strain> strain_rate(const YieldProblem<Geometry>& problem,
                                    const std::vector<Vec<Geometry::dim>>& v, int c, int k) {
  const auto& nodes = problem.grid.cell_nodes[c];
  Vec<Geometry::n_strain> q = problem.quadrature.B[c][k][0] * v[nodes[0]];
  for (int i = 1; i < power(3, Geometry::dim); ++i)
    q.noalias() += problem.quadrature.B[c][k][i] * v[nodes[i]];
  return q;
}

/// Mean divergence of cell c.
template <class Geometry>
double divergence(const YieldProblem<Geometry>& problem, const std::vector<Vec<Geometry::dim>>& v, int c) {
  const auto& nodes = problem.grid.cell_nodes[c];
  const auto& b = problem.quadrature.divergence_rows(c);
  double div = 0.0;
  for (int i = 0; i < power(3, Geometry::dim); ++i) div += b[i].dot(v[nodes[i]]);
  return div;
}

/// How far the divergence of the strain rate q is from its cell's mean; 0 where q does not tell it.
template <class Geometry>
double excess_divergence(const Vec<Geometry::n_strain>& q, double mean) {
  if constexpr (requires { Geometry::divergence_of(q); })
    return Geometry::divergence_of(q) - mean;
  else
    return 0.0;
}

/// The same at quadrature point k of cell c by its rows, where they are laid out.
template <class Geometry>
double excess_divergence(const YieldProblem<Geometry>& problem, const std::vector<Vec<Geometry::dim>>& v,
                         int c, int k) {
  double excess = 0.0;
  for (int i = 0; i < power(3, Geometry::dim); ++i)
    excess += problem.quadrature.excess[c][k][i].dot(v[problem.grid.cell_nodes[c][i]]);
  return excess;
}

/// Turns the strain rates of a cell's quadrature points into stresses, in place.
template <class Geometry>
using CellStresses =
    std::function<void(int c, std::array<Vec<Geometry::n_strain>, power(2, Geometry::dim)>& q)>;
/// Multiplies the strain rows of quadrature point k of cell c by V times its tangent, in place.
template <class Geometry>
using CellTangents = std::function<void(int c, int k, double V,
                                        Mat<Geometry::n_strain, power(3, Geometry::dim) * Geometry::dim>& B)>;

namespace detail {

// Compiled once for each geometry; what the laws give comes by one call a cell, and one a quadrature point.
template <class Geometry>
Eigen::VectorXd residual_of_cells(const YieldProblem<Geometry>& problem,
                                  const std::vector<Vec<Geometry::dim>>& v,
                                  const CellStresses<Geometry>& stresses);
template <class Geometry>
void assemble_cells(const YieldProblem<Geometry>& problem, const CellTangents<Geometry>& tangents,
                    BlockSystem<Geometry::dim>& system);

}  // namespace detail

/// Nodal forces at velocities v of everything but the yield forces, which each solver adds in its own way (Newton:
/// add_node_forces_newton(), ADMM: add_node_forces_admm()): inertia, pressure, zeta, drag, moving contact, terms at points; plus the deviatoric forces of the stresses that
/// `stress(c, k, q)` returns for the strain rate q. Each pushes along its axis where it is positive; zero in equilibrium.
template <class Geometry, class Stress>
Eigen::VectorXd residual(const YieldProblem<Geometry>& problem, const std::vector<Vec<Geometry::dim>>& v,
                         Stress stress) {
  return detail::residual_of_cells<Geometry>(problem, v, [&stress](int c, auto& q) {
    for (int k = 0; k < power(2, Geometry::dim); ++k) q[k] = stress(c, k, q[k]);
  });
}

/// Volume of the concrete around each node: an equal share of every cell that it touches [m^3].
template <class Geometry>
std::vector<double> volumes_around_nodes(const YieldProblem<Geometry>& problem) {
  std::vector<double> V(problem.grid.node_index.size(), 0.0);
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int i : problem.grid.cell_nodes[c]) V[i] += problem.quadrature.V_cell[c] / power(3, Geometry::dim);
  fold_mirrors<Geometry::dim>(problem.grid, V);
  return V;
}

/// A point on the very edge of a cell gives some of its nodes no mass; a trace of the largest keeps the matrices definite.
inline double trace_of_mass(const std::vector<double>& mass) {
  double trace = 0.0;
  for (double m : mass) trace = std::max(trace, 1e-12 * m);
  return trace;
}

/// Sets to zero what walls prescribe.
inline void mask(const std::vector<char>& fixed, Eigen::VectorXd& R) {
#pragma omp parallel for schedule(static) if (R.size() > 10'000)
  for (Eigen::Index i = 0; i < R.size(); ++i)
    if (fixed[i]) R[i] = 0.0;
}

/// Assembles what residual() has, and the deviatoric stiffness V B' T B with the tangents T = tangent(c, k), a number or a
/// matrix.
template <class Geometry, class Tangent>
void assemble(const YieldProblem<Geometry>& problem, Tangent tangent, BlockSystem<Geometry::dim>& system) {
  detail::assemble_cells<Geometry>(
      problem, [&tangent](int c, int k, double V, auto& B) { B = (V * tangent(c, k) * B).eval(); }, system);
}

}  // namespace tremie
