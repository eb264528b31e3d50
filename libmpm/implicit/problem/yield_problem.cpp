#include "libmpm/implicit/problem/yield_problem.hpp"

#include "libmpm/geometry/cylindrical.hpp"
#include "libmpm/geometry/spaces.hpp"

namespace tremie::detail {

template <class Geometry>
Eigen::VectorXd residual_of_cells(const YieldProblem<Geometry>& problem,
                                  const std::vector<Vec<Geometry::dim>>& v,
                                  const CellStresses<Geometry>& stresses) {
  constexpr int D = Geometry::dim, n_local = power(3, D);
  const auto& grid = problem.grid;
  const auto& quad = problem.quadrature;
  std::vector<std::array<Vec<D>, n_local>> local(grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const double div = divergence(problem, v, c), p = problem.offset(c) - problem.K * problem.dt * div;
    const auto& b = quad.divergence_rows(c);
    for (int i = 0; i < n_local; ++i) local[c][i] = quad.V_cell[c] * p * b[i];
    std::array<Vec<Geometry::n_strain>, power(2, D)> q, of_rates;
    for (int k = 0; k < power(2, D); ++k) q[k] = of_rates[k] = strain_rate(problem, v, c, k);
    stresses(c, of_rates);
    for (int k = 0; k < power(2, D); ++k) {
      Vec<Geometry::n_strain> s = quad.V[c][k] * of_rates[k];
      if constexpr (requires { Geometry::divergence_of(q[k]); })
        s += quad.V[c][k] * problem.zeta * excess_divergence<Geometry>(q[k], div) *
             Geometry::divergence_part();
      for (int i = 0; i < n_local; ++i) local[c][i].noalias() -= quad.B[c][k][i].transpose() * s;
    }
    if (!quad.excess.empty())
      for (int k = 0; k < power(2, D); ++k) {
        const double s = quad.V[c][k] * problem.zeta * excess_divergence(problem, v, c, k);
        for (int i = 0; i < n_local; ++i) local[c][i] -= s * quad.excess[c][k][i];
      }
  }
  Eigen::VectorXd R(grid.n_nodes() * D);
  for (int i = 0; i < grid.n_nodes(); ++i)
    R.segment<D>(i * D) = problem.nodes.mass[i] / problem.dt * (problem.nodes.v[i] - v[i]);
  for (std::size_t i = 0; i < problem.drag.size(); ++i) {
    auto of_node = R.segment<D>(static_cast<Eigen::Index>(i) * D);
    of_node -= problem.drag[i].k * v[i];
    of_node += problem.drag[i].pull;
  }
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int i = 0; i < n_local; ++i) R.segment<D>(grid.cell_nodes[c][i] * D) += local[c][i];
  add_contact_forces<D>(problem.contact, grid.cell_nodes, v, R);
  for (const auto& terms : problem.points()) add_penalty_forces<D>(terms, grid.cell_nodes, v, R);
  fold_mirrors<D>(grid, R);
  return R;
}

template <class Geometry>
void assemble_cells(const YieldProblem<Geometry>& problem, const CellTangents<Geometry>& tangents,
                    BlockSystem<Geometry::dim>& system) {
  constexpr int D = Geometry::dim, n_dof = power(3, D) * D, ns = Geometry::n_strain;
  const auto& quad = problem.quadrature;
  system.set_zero();
  for (int c = 0; c < problem.grid.n_cells(); ++c) {
    Eigen::Matrix<double, ns, n_dof> B;
    Eigen::Matrix<double, n_dof, n_dof> cell = Eigen::Matrix<double, n_dof, n_dof>::Zero();
    double bulk = problem.K * problem.dt;
    // zeta resists how div_q differs from its mean: sum_q V_q (div_q - div)^2 = sum_q V_q div_q^2 - V_c div^2.
    if constexpr (requires { Geometry::divergence_part(); }) bulk -= problem.zeta;
    for (int k = 0; k < power(2, D); ++k) {
      for (int i = 0; i < power(3, D); ++i) B.template middleCols<D>(i * D) = quad.B[c][k][i];
      Eigen::Matrix<double, ns, n_dof> TB = B;
      tangents(c, k, quad.V[c][k], TB);
      if constexpr (requires { Geometry::divergence_part(); })
        TB += (quad.V[c][k] * problem.zeta) * Geometry::divergence_part() *
              (Geometry::divergence_part().transpose() * B);
      cell.noalias() += B.transpose() * TB;
      if (!quad.excess.empty()) {
        const Eigen::Map<const Vec<n_dof>> x(quad.excess[c][k][0].data());
        cell.noalias() += (quad.V[c][k] * problem.zeta * x) * x.transpose();
      }
    }
    const auto& rows = quad.divergence_rows(c);
    Vec<n_dof> b;
    for (int i = 0; i < power(3, D); ++i) b.template segment<D>(i * D) = rows[i];
    cell.noalias() += (quad.V_cell[c] * bulk * b) * b.transpose();
    system.add_cell(c, cell);
  }
  const double trace = trace_of_mass(problem.nodes.mass);
  for (int i = 0; i < problem.grid.n_nodes(); ++i)
    for (int d = 0; d < D; ++d)
      system.add_diagonal(i, d,
                          std::max(trace, problem.nodes.mass[i]) / problem.dt +
                              (problem.drag.empty() ? 0.0 : problem.drag[i].k));
  add_contact_stiffness<D>(problem.contact, system);
  for (const auto& terms : problem.points()) add_penalty_stiffness<D>(terms, system);
}

#define TREMIE_YIELD_PROBLEM_IN(Geometry)                                                                    \
  template Eigen::VectorXd residual_of_cells(                                                                \
      const YieldProblem<Geometry>&, const std::vector<Vec<Geometry::dim>>&, const CellStresses<Geometry>&); \
  template void assemble_cells(const YieldProblem<Geometry>&, const CellTangents<Geometry>&,                 \
                               BlockSystem<Geometry::dim>&);
TREMIE_IN_ALL_SPACES(TREMIE_YIELD_PROBLEM_IN)
#ifndef TREMIE_SECTIONS_ONLY
TREMIE_YIELD_PROBLEM_IN(Cylindrical)
#endif

}  // namespace tremie::detail
