#pragma once

// admm.hpp's method in space: the same iteration, the linear solves by conjugate gradients that go on from
// the last ones and are no more exact than the iteration needs, the duals updated a batch of cells at a time.

#include "libmpm/step/admm.hpp"
#include "libmpm/step/space_system.hpp"

namespace tremie {

namespace detail {

/// Yield stresses and rates by cells become duals, and duals those.
inline SpaceDuals joined(const Duals<ThreeD>& duals, const Quadrature<ThreeD>& quadrature) {
  const int n_cells = static_cast<int>(duals.stress.size());
  SpaceDuals joined = no_duals(n_cells);
  for (int c = 0; c < n_cells; ++c)
    for (int k = 0; k < 8; ++k) {
      SpaceDuals::Batch& b = joined.batch[c / batch_size];
      b.tau_y[k][c % batch_size] = quadrature.tau_y[c][k];
      for (int j = 0; j < 5; ++j)
        b.a[k][j][c % batch_size] = duals.stress[c][k][j] + joined.r * duals.rate[c][k][j];
    }
  return joined;
}
template <class Law>
Duals<ThreeD> split(const Law& law, const SpaceDuals& joined, int n_cells) {
  Duals<ThreeD> duals;
  duals.stress.resize(n_cells), duals.rate.resize(n_cells);
  for (int c = 0; c < n_cells; ++c)
    for (int k = 0; k < 8; ++k) {
      const SpaceDuals::Batch& b = joined.batch[c / batch_size];
      duals.stress[c][k] = stress_of(law, joined, c, k);
      for (int j = 0; j < 5; ++j)
        duals.rate[c][k][j] = (b.a[k][j][c % batch_size] - duals.stress[c][k][j]) / joined.r;
    }
  return duals;
}

/// One pass over the cells at the velocities v: updates the duals if asked to, adds up the mismatch, and
/// the forces R of stress, pressure and closed contacts on the nodes.
template <class Law>
Mismatch pass_over_cells(const YieldProblem<ThreeD>& problem, const Law& law, const AdmmSettings& settings,
                         double r, const std::vector<Vec<3>>& v, bool update, SpaceSystem& system,
                         SpaceDuals& duals, Eigen::VectorXd& R) {
  const double mu = problem.mu, rho = settings.over_relaxation, bulk = problem.K * problem.dt;
  const auto& quad = problem.quadrature;
  const int last = problem.grid.n_cells() - 1;
  std::vector<Mismatch> part(duals.batch.size());
  R.resize(3 * problem.grid.n_nodes());
  const auto give_batch = [&](int b, double* to) {
    PlaceTensors<double> G;
    system.batches.gradients(b, v.data()->data(), G);
    const BatchVolumes<double> vol = batch_volumes(quad, b);
    SpaceDuals::Batch& own = duals.batch[b];
    Lanes<double> p, mean = Lanes<double>::Zero(), primal = mean, dual = mean, scale = mean;
    for (int l = 0; l < batch_size; ++l) p[l] = quad.p[std::min(b * batch_size + l, last)];
    for (int k = 0; k < 8; ++k) mean += vol.V[k] * (G.g[0][0][k] + G.g[1][1][k] + G.g[2][2][k]);
    p -= bulk * vol.inverse_cell * mean;
    for (int k = 0; k < 8; ++k) {
      Lanes<double> q[5], s[5], d[5], div, stress[5], tau_y;
      strain_at(G, k, q, div);
      for (int l = 0; l < batch_size; ++l) tau_y[l] = quad.tau_y[std::min(b * batch_size + l, last)][k];
      split_dual(law, own.a[k], own.tau_y[k], duals.r, s, d);
      if (update) {
        Lanes<double>(&a)[5] = own.a[k];
        Lanes<double> s_new[5], d_new[5];
        for (int j = 0; j < 5; ++j) a[j] = s[j] + r * (rho * q[j] + (1.0 - rho) * d[j]);
        split_dual(law, a, tau_y, r, s_new, d_new);
        own.tau_y[k] = tau_y;
        for (int j = 0; j < 5; ++j) {
          primal += vol.V[k] * (q[j] - d_new[j]).square();
          dual += vol.V[k] * (d_new[j] - d[j]).square();
          s[j] = s_new[j], d[j] = d_new[j];
        }
      }
      scale += vol.V[k] * (tau_y + mu * norm(q) + no_stress).square();
      for (int j = 0; j < 5; ++j) stress[j] = -vol.V[k] * (mu * q[j] + s[j] + r * (q[j] - d[j]));
      stress_at<double>(stress, vol.V[k] * p, k, G);
    }
    system.batches.scatter(b, G, to);
    part[b] = {r * r * sum_of(primal), r * r * sum_of(dual), sum_of(scale)};
  };
  const auto give = [&](int strip, double* to) {
    for (int b = system.batches.first_batch(strip); b < system.batches.last_batch(strip); ++b)
      give_batch(b, to);
    for_each_contact(problem.contact, system.batches.strips(), strip, [&](const ContactPoint<3>& c) {
      add_at_contact(c, problem.grid.cell_nodes[c.cell],
                     c.stiffness * (c.target - normal_velocity(c, problem.grid.cell_nodes, v)), to);
    });
  };
#pragma omp parallel
  system.batches.strips().sweep_in_region<double>(system.forces, give, [&](int i) {
    R.segment<3>(3 * i) = system.batches.strips().sum_at<double, 3>(i, system.forces);
  });
  if (update) duals.r = r;
  Mismatch sum;
  for (const Mismatch& m : part) sum.primal += m.primal, sum.dual += m.dual, sum.scale += m.scale;
  return sum;
}

/// Adds all other forces at v to what pass_over_cells() found.
inline void residual_in_space(const YieldProblem<ThreeD>& problem, const std::vector<Vec<3>>& v,
                              Eigen::VectorXd& R) {
#pragma omp parallel for schedule(static)
  for (int i = 0; i < problem.grid.n_nodes(); ++i)
    R.segment<3>(3 * i) = problem.nodes.mass[i] / problem.dt * (problem.nodes.v[i] - v[i]) -
                          (problem.drag.empty() ? 0.0 : problem.drag[i]) * v[i] + R.segment<3>(3 * i);
  add_bound_forces<3>(problem.bound, problem.grid.cell_nodes, v, R);
  add_friction_forces_admm<3>(problem.friction, v, R);
  fold_mirrors<3>(problem.grid, R);
  mask(problem.fixed, R);
}

}  // namespace detail

/// solve_admm() in space, without a matrix.
template <class Law>
SolveReport solve_admm_in_space(YieldProblem<ThreeD>& problem, const Law& law, const AdmmSettings& settings,
                                SpaceSystem& system, std::vector<Vec<3>>& v, SpaceDuals& duals) {
  const double r = detail::penalty(problem, settings.penalty_by_iteration), eta = problem.mu + r;
  SolveReport report;
  system.set_up(problem, settings.most_band_operations);
  if (!system.prepare(problem, eta)) return report;
  Eigen::VectorXd R;
  auto mismatch = detail::pass_over_cells(problem, law, settings, r, v, false, system, duals, R);
  for (; report.iterations < settings.max_iterations; ++report.iterations) {
    detail::residual_in_space(problem, v, R);
    // An error e of v that the solve leaves is worth a stress of (mu + r) |q(e)|, whose square over the
    // volume is at most mu + r times its energy (r, A^-1 r): no more of it than the iteration tolerates.
    const double tolerated = std::pow(settings.tolerance, 2) * mismatch.scale / eta;
    const double left = system.solve(
        problem, R, {.reduction = settings.solve_reduction, .enough = settings.solve_share * tolerated}, v);
    const bool contact_changed = update_active<3>(problem.contact, problem.grid.cell_nodes, v);
    const bool friction_settled =
        update_friction_admm<3>(problem.friction, v, settings.over_relaxation, settings.tolerance);
    mismatch = detail::pass_over_cells(problem, law, settings, r, v, true, system, duals, R);
    report.converged =
        mismatch.within(settings.tolerance) && friction_settled && !contact_changed && left <= tolerated;
    if (report.converged) break;
  }
  return report;
}

}  // namespace tremie
