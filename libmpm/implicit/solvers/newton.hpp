#pragma once

// Primal-dual Newton for the yield problem. With the dual stress s of each quadrature point, |s| <= f, the tangent
//
//   T = (mu + secant) I + slope/secant sym(s q')          (s = secant q at the solution: the exact tangent)
//
// stays positive and does not collapse where the law is nearly a kink (Chan, Golub and Mulet 1999 for total
// variation). The dual takes the full step, the velocities an Armijo step on the energy.

#include <algorithm>
#include <cmath>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/implicit/problem/yield_problem.hpp"

namespace tremie {

struct NewtonSettings {
  double tolerance = 1e-4;  ///< residual force, relative to the weight and inertia of the concrete
  int max_iterations = 80;
  double armijo = 1e-4;
};

namespace detail {

template <class Geometry>
double energy(const YieldProblem<Geometry>& problem, const YieldLaw& law,
              const std::vector<Vec<Geometry::dim>>& v) {
  const auto& quad = problem.quadrature;
  double sum = 0.0;
  for (int i = 0; i < problem.grid.n_nodes(); ++i)
    sum += 0.5 * problem.nodes.mass[i] / problem.dt * (v[i] - problem.nodes.v[i]).squaredNorm();
  for (int c = 0; c < problem.grid.n_cells(); ++c) {
    const double div = divergence(problem, v, c);
    sum += quad.V_cell[c] * div * (0.5 * problem.K * problem.dt * div - problem.offset(c));
    for (int k = 0; k < power(2, Geometry::dim); ++k) {
      const auto q = strain_rate(problem, v, c, k);
      const double gamma_dot = q.norm(), excess = quad.excess.empty() ? excess_divergence<Geometry>(q, div)
                                                                      : excess_divergence(problem, v, c, k);
      sum +=
          quad.V[c][k] * (0.5 * problem.mu * gamma_dot * gamma_dot +
                          potential(law, gamma_dot, quad.tau_y[c][k]) + 0.5 * problem.zeta * excess * excess);
    }
  }
  for (std::size_t i = 0; i < problem.drag.size(); ++i) {
    sum += 0.5 * problem.drag[i].k * v[i].squaredNorm();
    sum -= problem.drag[i].pull.dot(v[i]);
  }
  return sum + penalty_energy<Geometry::dim>(problem.bound, problem.grid.cell_nodes, v) +
         penalty_energy<Geometry::dim>(problem.surface, problem.grid.cell_nodes, v) +
         contact_energy<Geometry::dim>(problem.contact, problem.grid.cell_nodes, v) +
         node_energy<Geometry::dim>(problem.wall_nodes, v);
}

/// The dual's share of the tangent, kept inside |s| <= f so that the tangent stays positive.
template <int N>
Mat<N, N> primal_dual_tangent(const YieldLaw& law, double mu, double tau_y, const Vec<N>& q,
                              const Vec<N>& s) {
  const double gamma_dot = q.norm(), own_secant = secant(law, gamma_dot, tau_y);
  const double factor = own_secant > 0.0 ? slope(law, gamma_dot, tau_y) / own_secant : 0.0;
  return (mu + own_secant) * Mat<N, N>::Identity() + 0.5 * factor * (s * q.transpose() + q * s.transpose());
}

/// Full Newton step of the dual stresses along dv, projected to the largest stress the yield part can carry.
template <class Geometry>
void step_dual_stress(const YieldProblem<Geometry>& problem, const YieldLaw& law,
                      const std::vector<Vec<Geometry::dim>>& v, const std::vector<Vec<Geometry::dim>>& dv,
                      AdmmState<Geometry>& admm_state) {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int k = 0; k < power(2, Geometry::dim); ++k) {
      const double tau_y = problem.quadrature.tau_y[c][k];
      const auto q = strain_rate(problem, v, c, k), dq = strain_rate(problem, dv, c, k);
      const double gamma_dot = q.norm(), own_secant = secant(law, gamma_dot, tau_y);
      const double factor = own_secant > 0.0 ? slope(law, gamma_dot, tau_y) / own_secant : 0.0;
      auto& s = admm_state.stress[c][k];
      s = own_secant * (q + dq) + factor * q.dot(dq) * s;
      const double size = s.norm();
      const double limit = dual_limit(law, (q + dq).norm(), tau_y);
      if (size > limit) s *= limit / size;
    }
}

/// Brings the dual stresses that are carried over from the last step inside what this one can carry: beyond it
/// the tangent is not positive.
template <class Geometry>
void project_dual_stress(YieldProblem<Geometry>& problem, const YieldLaw& law,
                         const std::vector<Vec<Geometry::dim>>& v, AdmmState<Geometry>& admm_state) {
  const auto inside = [](auto& s, double limit) {
    const double size = s.norm();
    if (size > limit) s *= limit / size;
  };
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int k = 0; k < power(2, Geometry::dim); ++k) {
      const double gamma_dot = is_viscous(law) ? strain_rate(problem, v, c, k).norm() : 0.0;
      inside(admm_state.stress[c][k], dual_limit(law, gamma_dot, problem.quadrature.tau_y[c][k]));
    }
  for (NodeTerm<Geometry::dim>& t : problem.wall_nodes) project_force(t);
}

}  // namespace detail

/// Solves the yield problem by primal-dual Newton from the guesses v and `admm_state`
/// (its stresses are the dual), which it overwrites.
template <class Geometry>
SolveReport solve_newton(YieldProblem<Geometry>& problem, const YieldLaw& law, const NewtonSettings& settings,
                         double force_scale, BlockSystem<Geometry::dim>& system,
                         std::vector<Vec<Geometry::dim>>& v, AdmmState<Geometry>& admm_state) {
  constexpr int D = Geometry::dim;
  const auto stress = [&](int c, int k, const Vec<Geometry::n_strain>& q) -> Vec<Geometry::n_strain> {
    return (problem.mu + secant(law, q.norm(), problem.quadrature.tau_y[c][k])) * q;
  };
  SolveReport report;
  detail::project_dual_stress(problem, law, v, admm_state);
  std::vector<Vec<D>> step(v.size()), trial(v.size());
  for (; report.iterations < settings.max_iterations; ++report.iterations) {
    update_active<D>(problem.contact, problem.grid.cell_nodes, v);
    Eigen::VectorXd R = residual(problem, v, stress);
    add_node_forces_newton<D>(problem.wall_nodes, v, R);
    mask(problem.fixed, R);
    report.converged = R.lpNorm<1>() <= settings.tolerance * force_scale;
    if (report.converged) break;

    assemble(
        problem,
        [&](int c, int k) {
          return detail::primal_dual_tangent<Geometry::n_strain>(
              law, problem.mu, problem.quadrature.tau_y[c][k], strain_rate(problem, v, c, k),
              admm_state.stress[c][k]);
        },
        system);
    for (const NodeTerm<D>& t : problem.wall_nodes)
      system.add_node_block(t.node, node_tangent<D>(t, slip_velocity(t, v)));
    system.fix(problem.fixed);
    if (!system.factorise()) return report;
    const Eigen::VectorXd dv = system.solve(R);
    for (std::size_t i = 0; i < v.size(); ++i) step[i] = dv.segment<D>(static_cast<Eigen::Index>(i) * D);
    fill_mirrors<D>(problem.grid, step);
    detail::step_dual_stress(problem, law, v, step, admm_state);
    update_newton<D>(v, dv, problem.wall_nodes);

    const double slope = R.dot(dv), start = detail::energy(problem, law, v);
    for (double t = 1.0; t > 1e-6; t *= 0.5) {
      for (std::size_t i = 0; i < v.size(); ++i) trial[i] = v[i] + t * step[i];
      if (detail::energy(problem, law, trial) <=
          start - settings.armijo * t * slope + 1e-14 * std::abs(start))
        break;
    }
    v.swap(trial);
  }
  return report;
}

}  // namespace tremie
