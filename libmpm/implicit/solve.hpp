#pragma once

// Solving a posed step: ADMM or Newton, with the yield forces of wall laws that follow the pressure renewed around it.
// Form: ByFactors or ByIteration, how the step's linear systems are solved.

#include "libmpm/implicit/by_factors.hpp"
#include "libmpm/implicit/by_iteration.hpp"

namespace tremie::detail {

/// Stress of a step's solution at quadrature point k of cell c, at the strain rate q there.
template <class Form, class Geometry>
auto stress_in(const YieldProblem<Geometry>& problem, const YieldLaw& law,
               const ImplicitBody<Geometry>& body) {
  return [&](int c, int k, const Vec<Geometry::n_strain>& q) -> Vec<Geometry::n_strain> {
    return problem.mu_at(c, k) * q + Form::stress(law, body.admm_state, c, k);
  };
}

/// Yield forces of the wall law from the reactions; returns the relative change of their sum.
template <class Form, class Geometry>
double renew_yield_forces(YieldProblem<Geometry>& problem, const YieldLaw& law, const WallLaw& wall_law,
                          const ImplicitBody<Geometry>& body) {
  constexpr int D = Geometry::dim;
  const Eigen::VectorXd R = residual(problem, body.v, stress_in<Form>(problem, law, body));
  double change = 0.0, sum = 0.0;
  for (NodeTerm<D>& t : problem.wall_nodes) {
    if (t.normal_axis < 0) continue;
    // R is what the wall must balance, and a wall only pushes: R points down the axis at its low wall, up it at its
    // high one; what pulls gives no yield force.
    const bool low =
        problem.grid.axes[t.normal_axis].on_low_wall(problem.grid.node_index[t.node][t.normal_axis]);
    const double reaction = (low ? -1.0 : 1.0) * R[t.node * D + t.normal_axis];
    const double limit = yield_force(wall_law, std::max(0.0, reaction));
    change += std::abs(limit - t.limit);
    sum += limit;
    t.limit = limit;
    project_force(t);
  }
  return sum > 0.0 ? change / sum : 0.0;
}

/// The yield forces have settled when the sum of their changes is less than this share of theirs.
inline constexpr double settled_share = 0.02;
/// So often they are renewed; a step that needs more has not converged.
inline constexpr int most_renewals = 20;

/// Solves, with the yield forces of a wall law that follows the pressure frozen inside and renewed until they settle.
template <class Form, class Geometry>
SolveReport solve_step(YieldProblem<Geometry>& problem, const YieldLaw& law, const StepSettings& settings,
                       ImplicitBody<Geometry>& body) {
  SolveReport solve = Form::solve(problem, law, settings, body);
  if (problem.wall_nodes.empty() || !follows_pressure(settings.wall_law)) return solve;
  for (int i = 0; i < most_renewals; ++i) {
    if (renew_yield_forces<Form>(problem, law, settings.wall_law, body) < settled_share) return solve;
    const int before = solve.iterations;
    solve = Form::solve(problem, law, settings, body);
    solve.iterations += before;
  }
  solve.converged = false;
  return solve;
}

}  // namespace tremie::detail
