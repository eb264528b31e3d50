#pragma once

// The convex problem of one backward-Euler step: find the nodal velocities v that minimise
//
//   1/2 (v - v*)' M (v - v*) / dt  +  sum_q V_q [mu/2 gamma_dot^2 + Phi(gamma_dot)]
//     +  sum_c V_c [K dt/2 (div v)^2 - p div v]  +  sum_q V_q zeta/2 (div_q v - div v)^2
//     +  contact  +  friction of walls  +  drag of side walls and bars,
//
// Phi the potential of the yield law, gamma_dot = |q| at quadrature point q, one divergence a cell. A velocity
// that alternates from node to node has none in any cell: nothing but the shear stress resists it, and in a
// fluid with little yield stress it gathers the points on every second face. zeta, a bulk viscosity of what
// differs from the cell's mean, does; of a resolved flow it sees next to nothing. Its stationarity is the
// momentum balance; its solvers are in admm.hpp and newton.hpp.

#include <algorithm>
#include <vector>

#include "libmpm/boundary/boundary_points.hpp"
#include "libmpm/boundary/contact.hpp"
#include "libmpm/boundary/slender_bars.hpp"
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
  std::conditional_t<Geometry::dim == 3, PackedAdmmState, Nothing> packed;
};

template <class Geometry>
struct YieldProblem {
  static constexpr int D = Geometry::dim;
  const ActiveGrid<D>& grid;
  const Quadrature<Geometry>& quadrature;
  const NodalState<D>& nodes;  ///< masses, and v* with gravity already in it
  double dt, mu;
  double K;                 ///< of the systems: the mix's, or as much as they can bear (admm_matrix_free.hpp)
  std::vector<char> fixed;  ///< a flag a component: prescribed by a wall
  std::vector<ContactPoint<D>> contact;   ///< moving rigid walls
  std::vector<FrictionNode<D>> friction;  ///< Coulomb friction on flat walls, yield drag of side walls
  std::vector<PenaltyPoint<D>> bound;     ///< walls inside the grid
  std::vector<PenaltyPoint<D>> surface;   ///< head of the moving free surface, in a section
  std::vector<double> drag;               ///< viscous drag of side walls, a node each [kg/s]; empty: none
  double zeta = 0.0;                      ///< [Pa s], plane strain alone
  std::vector<double> p_offset = {};      ///< of the cells' pressures [Pa]; empty: those before the step
  double K_share = 1.0;                   ///< K over the mix's
  SlenderBars<D> bars = {};               ///< thinner than the grid resolves; ADMM alone
  double eta =
      mu;  ///< viscosity that scales stresses: mu, and the law's at the rate of the last step, within viscosity_scale_rates

  /// Pressure of cell c without divergence.
  double offset(int c) const { return p_offset.empty() ? quadrature.p[c] : p_offset[c]; }
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

/// Nodal forces at velocities v of everything but yield and friction, which each solver adds in its own way
/// (Newton: add_friction_forces(), ADMM: add_friction_forces_admm()): inertia, pressure, walls inside the grid, moving
/// contact, bars, drag; plus
/// the deviatoric forces of the stresses that `stress(c, k, q)` returns for the strain rate q.
template <class Geometry, class Stress>
Eigen::VectorXd residual(const YieldProblem<Geometry>& problem, const std::vector<Vec<Geometry::dim>>& v,
                         Stress stress) {
  constexpr int D = Geometry::dim, n_local = power(3, D);
  const auto& grid = problem.grid;
  const auto& quad = problem.quadrature;
  std::vector<std::array<Vec<D>, n_local>> local(grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const double div = divergence(problem, v, c), p = problem.offset(c) - problem.K * problem.dt * div;
    const auto& b = quad.divergence_rows(c);
    for (int i = 0; i < n_local; ++i) local[c][i] = quad.V_cell[c] * p * b[i];
    for (int k = 0; k < power(2, D); ++k) {
      const Vec<Geometry::n_strain> q = strain_rate(problem, v, c, k);
      Vec<Geometry::n_strain> s = quad.V[c][k] * stress(c, k, q);
      if constexpr (requires { Geometry::divergence_of(q); })
        s += quad.V[c][k] * problem.zeta * excess_divergence<Geometry>(q, div) * Geometry::divergence_part();
      for (int i = 0; i < n_local; ++i) local[c][i].noalias() -= quad.B[c][k][i].transpose() * s;
    }
  }
  Eigen::VectorXd R(grid.n_nodes() * D);
  for (int i = 0; i < grid.n_nodes(); ++i)
    R.segment<D>(i * D) = problem.nodes.mass[i] / problem.dt * (problem.nodes.v[i] - v[i]);
  for (std::size_t i = 0; i < problem.drag.size(); ++i)
    R.segment<D>(static_cast<Eigen::Index>(i) * D) -= problem.drag[i] * v[i];
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int i = 0; i < n_local; ++i) R.segment<D>(grid.cell_nodes[c][i] * D) += local[c][i];
  add_contact_forces<D>(problem.contact, grid.cell_nodes, v, R);
  add_penalty_forces<D>(problem.bound, grid.cell_nodes, v, R);
  add_penalty_forces<D>(problem.surface, grid.cell_nodes, v, R);
  add_penalty_forces<D>(problem.bars.points, grid.cell_nodes, v, R);
  fold_mirrors<D>(grid, R);
  return R;
}

/// Sets to zero what walls prescribe.
inline void mask(const std::vector<char>& fixed, Eigen::VectorXd& R) {
#pragma omp parallel for schedule(static) if (R.size() > 10'000)
  for (Eigen::Index i = 0; i < R.size(); ++i)
    if (fixed[static_cast<std::size_t>(i)]) R[i] = 0.0;
}

/// Assembles inertia, bulk and contact, and the deviatoric stiffness V B' T B with the tangents T =
/// tangent(c, k).
template <class Geometry, class Tangent>
void assemble(const YieldProblem<Geometry>& problem, Tangent tangent, BlockSystem<Geometry::dim>& system) {
  constexpr int D = Geometry::dim, n_dof = power(3, D) * D, ns = Geometry::n_strain;
  const auto& quad = problem.quadrature;
  system.set_zero();
  for (int c = 0; c < problem.grid.n_cells(); ++c) {
    Eigen::Matrix<double, ns, n_dof> B;
    Eigen::Matrix<double, n_dof, n_dof> cell = Eigen::Matrix<double, n_dof, n_dof>::Zero();
    double bulk = problem.K * problem.dt;
    if constexpr (requires { Geometry::divergence_part(); }) bulk -= problem.zeta;
    for (int k = 0; k < power(2, D); ++k) {
      for (int i = 0; i < power(3, D); ++i) B.template middleCols<D>(i * D) = quad.B[c][k][i];
      Eigen::Matrix<double, ns, n_dof> TB = quad.V[c][k] * tangent(c, k) * B;
      if constexpr (requires { Geometry::divergence_part(); })
        TB += (quad.V[c][k] * problem.zeta) * Geometry::divergence_part() *
              (Geometry::divergence_part().transpose() * B);
      cell.noalias() += B.transpose() * TB;
    }
    const auto& rows = quad.divergence_rows(c);
    Vec<n_dof> b;
    for (int i = 0; i < power(3, D); ++i) b.template segment<D>(i * D) = rows[i];
    cell.noalias() += (quad.V_cell[c] * bulk * b) * b.transpose();
    system.add_cell(c, cell);
  }
  // A point on the very edge of a cell gives some of its nodes no mass; a trace of it keeps the matrix
  // definite.
  double trace = 0.0;
  for (double m : problem.nodes.mass) trace = std::max(trace, 1e-12 * m);
  for (int i = 0; i < problem.grid.n_nodes(); ++i)
    for (int d = 0; d < D; ++d)
      system.add_diagonal(i, d,
                          std::max(trace, problem.nodes.mass[i]) / problem.dt +
                              (problem.drag.empty() ? 0.0 : problem.drag[i]));
  add_contact_stiffness<D>(problem.contact, system);
  add_penalty_stiffness<D>(problem.bound, system);
  add_penalty_stiffness<D>(problem.surface, system);
  add_penalty_stiffness<D>(problem.bars.points, system);
}

}  // namespace tremie
