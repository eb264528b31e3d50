#pragma once

// Solving a posed step: ADMM or Newton, with the normal forces of Coulomb friction renewed around it.

#include "libmpm/implicit/carry_over.hpp"
#include "libmpm/implicit/step_size.hpp"

namespace tremie::detail {

/// Stress of the yield part at quadrature point k of cell c.
template <class Geometry>
Vec<Geometry::n_strain> stress_of(const YieldLaw& law, const AdmmState<Geometry>& admm_state, int c, int k) {
  if constexpr (Geometry::dim == 3)
    if (!admm_state.packed.empty()) return stress_of(law, admm_state.packed, c, k);
  return admm_state.stress[c][k];
}

/// Weight and inertia that the residual of a Newton step is measured against [N].
template <class Geometry>
double force_scale(const ImplicitBody<Geometry>& body, double dt) {
  double scale = 0.0;
  for (int i = 0; i < body.grid.n_nodes(); ++i)
    scale += body.nodes.mass[i] * (body.gravity.norm() + 1e-3 * body.nodes.v[i].norm() / dt);
  return scale;
}

/// Solves with the chosen method; `automatic` is ADMM, and Newton where ADMM does not converge. With bars it is ADMM
/// alone.
template <class Geometry>
SolveReport solve_yield(YieldProblem<Geometry>& problem, const YieldLaw& law, const StepSettings& settings,
                        ImplicitBody<Geometry>& body) {
  if constexpr (Geometry::dim == 3)
    if (by_iteration(body, settings)) {
      MatrixFreeAdmm form{problem, law, settings.admm, body.matrix_free, body.admm_state.packed};
      return solve_admm(problem, settings.admm, form, body.v);
    }
  const double scale = force_scale(body, problem.dt);
  body.system.set_pattern(body.grid);
  if (settings.method == YieldMethod::newton && problem.bars.drag.empty())
    return solve_newton(problem, law, settings.newton, scale, body.system, body.v, body.admm_state);
  FactorisedAdmm<Geometry> form{problem, law, settings.admm, body.system, body.admm_state};
  SolveReport report = solve_admm(problem, settings.admm, form, body.v);
  if (report.converged || settings.method == YieldMethod::admm || !problem.bars.drag.empty()) return report;
  const int before = report.iterations;
  report = solve_newton(problem, law, settings.newton, scale, body.system, body.v, body.admm_state);
  report.iterations += before;
  return report;
}

/// Normal forces of the friction nodes from the reactions; returns the relative change of their sum.
template <class Geometry>
double update_normal_forces(YieldProblem<Geometry>& problem, const YieldLaw& law, double coefficient,
                            const ImplicitBody<Geometry>& body) {
  constexpr int D = Geometry::dim;
  const auto stress = [&](int c, int k, const Vec<Geometry::n_strain>& q) -> Vec<Geometry::n_strain> {
    return problem.mu * q + stress_of(law, body.admm_state, c, k);
  };
  const Eigen::VectorXd R = residual(problem, body.v, stress);
  double change = 0.0, sum = 0.0;
  for (FrictionNode<D>& f : problem.friction) {
    if (f.normal_axis < 0) continue;
    // R is what the wall must balance, and a wall only pushes: R points down the axis at its low wall, up it at its
    // high one; what pulls gives no friction.
    const bool low =
        problem.grid.axes[f.normal_axis].on_low_wall(problem.grid.node_index[f.node][f.normal_axis]);
    const double reaction = (low ? -1.0 : 1.0) * R[f.node * D + f.normal_axis];
    const double limit = coefficient * std::max(0.0, reaction);
    change += std::abs(limit - f.limit);
    sum += limit;
    f.limit = limit;
    const double size = f.force.norm();
    if (size > limit) f.force *= limit / size;
  }
  return sum > 0.0 ? change / sum : 0.0;
}

/// The normal forces have settled when the sum of their changes is less than this share of theirs.
inline constexpr double settled_share = 0.02;
/// So often they are renewed; a step that needs more has not converged.
inline constexpr int most_renewals = 20;

/// Solves, with the normal forces of Coulomb friction frozen inside and renewed until they settle.
template <class Geometry>
SolveReport solve_step(YieldProblem<Geometry>& problem, const YieldLaw& law, const StepSettings& settings,
                       ImplicitBody<Geometry>& body) {
  SolveReport solve = solve_yield(problem, law, settings, body);
  if (problem.friction.empty()) return solve;
  for (int i = 0; i < most_renewals; ++i) {
    if (update_normal_forces(problem, law, settings.friction_coefficient, body) < settled_share) return solve;
    const int before = solve.iterations;
    solve = solve_yield(problem, law, settings, body);
    solve.iterations += before;
  }
  solve.converged = false;
  return solve;
}

/// Whether the step would carry concrete so many cells or to nowhere: more of it than the share that may be
/// drops in the air. Nodes with next to no mass do not count: what they do moves no point.
template <class Geometry>
bool runs_away(const ImplicitBody<Geometry>& body, double share, double dt, double cells = 100.0) {
  const double reach = cells * body.grid.cell_size_min();
  double heaviest = 0.0, total = 0.0, gone = 0.0;
  for (double m : body.nodes.mass) heaviest = std::max(heaviest, m), total += m;
  for (std::size_t i = 0; i < body.v.size(); ++i) {
    if (!body.v[i].allFinite()) return true;
    const double m = body.nodes.mass[i];
    if (Geometry::advects && m > 1e-3 * heaviest && body.v[i].norm() * dt > reach) gone += m;
  }
  return gone > share * total;
}

/// Whether a long step carries more than some drops beyond a cell, or anything beyond ten: the speeds that it
/// was chosen for say nothing of what comes loose in it.
template <class Geometry>
bool starts_to_fall(const ImplicitBody<Geometry>& body, const StepSettings& settings, double dt) {
  return runs_away(body, detached_share, dt, 1.0) || runs_away(body, settings.detached, dt, 10.0);
}

/// The ADMM state that another try at a step over dt starts from: the one that the step began with; in a large body,
/// where no memory is spent on it, what the last try found, or none if that ran away.
template <class Geometry>
void guess_again(const std::optional<AdmmState<Geometry>>& first, const StepSettings& settings, double dt,
                 ImplicitBody<Geometry>& body) {
  if (first)
    body.admm_state = *first;
  else if constexpr (Geometry::dim == 3)
    if (runs_away(body, settings.detached, dt)) body.admm_state.packed = zero_admm_state(body.grid.n_cells());
}

}  // namespace tremie::detail
