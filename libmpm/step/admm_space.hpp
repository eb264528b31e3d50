#pragma once

// admm.hpp's method in space: the same iteration, the linear solves by conjugate gradients that go on from
// the last ones and are no more exact than the iteration needs, the duals updated a batch of cells at a time.

#include "libmpm/step/admm.hpp"
#include "libmpm/step/space_system.hpp"

namespace tremie {

namespace detail {

/// Duals and yield stresses by batches of cells.
struct BatchDuals {
  Lanes<double> stress[8][5], rate[8][5], tau_y[8];
};

template <class Visit>
void for_each_lane(int n_cells, Visit visit) {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < n_cells; ++c) visit(c, c / batch_size, c % batch_size);
}

inline std::vector<BatchDuals> to_batches(const YieldProblem<ThreeD>& problem, const Duals<ThreeD>& duals,
                                          int n_batches) {
  std::vector<BatchDuals> batch(n_batches);
  for (BatchDuals& b : batch)
    for (int k = 0; k < 8; ++k) {
      b.tau_y[k].setZero();
      for (int j = 0; j < 5; ++j) b.stress[k][j].setZero(), b.rate[k][j].setZero();
    }
  for_each_lane(problem.grid.n_cells(), [&](int c, int b, int l) {
    for (int k = 0; k < 8; ++k) {
      batch[b].tau_y[k][l] = problem.quadrature.tau_y[c][k];
      for (int j = 0; j < 5; ++j)
        batch[b].stress[k][j][l] = duals.stress[c][k][j], batch[b].rate[k][j][l] = duals.rate[c][k][j];
    }
  });
  return batch;
}

inline void from_batches(const std::vector<BatchDuals>& batch, Duals<ThreeD>& duals) {
  for_each_lane(static_cast<int>(duals.stress.size()), [&](int c, int b, int l) {
    for (int k = 0; k < 8; ++k)
      for (int j = 0; j < 5; ++j)
        duals.stress[c][k][j] = batch[b].stress[k][j][l], duals.rate[c][k][j] = batch[b].rate[k][j][l];
  });
}

/// One pass over the cells at the velocities v: updates the duals if asked to, adds up the mismatch, and
/// stores the forces of stress and pressure on the nodes.
template <class Law>
Mismatch pass_over_cells(const YieldProblem<ThreeD>& problem, const Law& law, const AdmmSettings& settings,
                         double r, const double* v, bool update, SpaceSystem& system,
                         std::vector<BatchDuals>& duals) {
  const double mu = problem.mu, rho = settings.over_relaxation, bulk = problem.K * problem.dt;
  const auto& p_cell = problem.quadrature.p;
  std::vector<Mismatch> part(duals.size());
#pragma omp parallel for schedule(static)
  for (int b = 0; b < system.batches.n_batches(); ++b) {
    PlaceTensors<double> G;
    system.batches.gradients(b, v, G);
    const BatchVolumes<double>& vol = system.volumes[b];
    Lanes<double> p, mean = Lanes<double>::Zero(), primal = mean, dual = mean, scale = mean;
    for (int l = 0; l < batch_size; ++l)
      p[l] = p_cell[std::min<std::size_t>(b * batch_size + l, p_cell.size() - 1)];
    for (int k = 0; k < 8; ++k) mean += vol.V[k] * (G.g[0][0][k] + G.g[1][1][k] + G.g[2][2][k]);
    p -= bulk * vol.inverse_cell * mean;
    for (int k = 0; k < 8; ++k) {
      Lanes<double> q[5], div, stress[5];
      strain_at(G, k, q, div);
      auto& s = duals[b].stress[k];
      auto& d = duals[b].rate[k];
      if (update) {
        Lanes<double> a[5];
        for (int j = 0; j < 5; ++j) a[j] = s[j] + r * (rho * q[j] + (1.0 - rho) * d[j]);
        const Lanes<double> a_norm = norm(a);
        Lanes<double> factor;
        for (int l = 0; l < batch_size; ++l)
          factor[l] = a_norm[l] > 0.0 ? law.prox(a_norm[l], duals[b].tau_y[k][l], r) / a_norm[l] : 0.0;
        for (int j = 0; j < 5; ++j) {
          const Lanes<double> d_new = factor * a[j];
          primal += vol.V[k] * (q[j] - d_new).square();
          dual += vol.V[k] * (d_new - d[j]).square();
          s[j] = a[j] - r * d_new;
          d[j] = d_new;
        }
      }
      scale += vol.V[k] * (duals[b].tau_y[k] + mu * norm(q) + no_stress).square();
      for (int j = 0; j < 5; ++j) stress[j] = -vol.V[k] * (mu * q[j] + s[j] + r * (q[j] - d[j]));
      stress_at<double>(stress, vol.V[k] * p, k, G);
    }
    system.batches.scatter(b, G, system.forces);
    part[b] = {r * r * primal.sum(), r * r * dual.sum(), scale.sum()};
  }
  Mismatch sum;
  for (const Mismatch& m : part) sum.primal += m.primal, sum.dual += m.dual, sum.scale += m.scale;
  return sum;
}

/// Forces on the nodes at v after pass_over_cells().
inline void residual_in_space(const YieldProblem<ThreeD>& problem, const SpaceSystem& system,
                              const std::vector<Vec<3>>& v, Eigen::VectorXd& R) {
  R.resize(3 * problem.grid.n_nodes());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < problem.grid.n_nodes(); ++i)
    R.segment<3>(3 * i) = problem.nodes.mass[i] / problem.dt * (problem.nodes.v[i] - v[i]) -
                          (problem.drag.empty() ? 0.0 : problem.drag[i]) * v[i] +
                          system.batches.gathered(i, system.forces);
  add_contact_forces<3>(problem.contact, problem.grid.cell_nodes, v, R);
  add_bound_forces<3>(problem.bound, problem.grid.cell_nodes, v, R);
  add_friction_forces_admm<3>(problem.friction, v, R);
  fold_mirrors<3>(problem.grid, R);
  mask(problem.fixed, R);
}

}  // namespace detail

/// solve_admm() in space, without a matrix.
template <class Law>
SolveReport solve_admm_in_space(YieldProblem<ThreeD>& problem, const Law& law, const AdmmSettings& settings,
                                SpaceSystem& system, std::vector<Vec<3>>& v, Duals<ThreeD>& duals) {
  const double r = detail::penalty(problem, settings.penalty_by_iteration), eta = problem.mu + r;
  SolveReport report;
  system.set_up(problem, settings.most_band_operations);
  if (!system.prepare(problem, eta)) return report;
  std::vector<detail::BatchDuals> batch = detail::to_batches(problem, duals, system.batches.n_batches());
  auto mismatch = detail::pass_over_cells(problem, law, settings, r, v.data()->data(), false, system, batch);
  Eigen::VectorXd R;
  for (; report.iterations < settings.max_iterations; ++report.iterations) {
    detail::residual_in_space(problem, system, v, R);
    // An error e of v that the solve leaves is worth a stress of (mu + r) |q(e)|, whose square over the
    // volume is at most mu + r times its energy (r, A^-1 r): no more of it than the iteration tolerates.
    const double tolerated = std::pow(settings.tolerance, 2) * mismatch.scale / eta;
    const double left = system.solve(
        problem, R, {.reduction = settings.solve_reduction, .enough = settings.solve_share * tolerated}, v);
    const bool contact_changed = update_active<3>(problem.contact, problem.grid.cell_nodes, v);
    const bool friction_settled =
        update_friction_admm<3>(problem.friction, v, settings.over_relaxation, settings.tolerance);
    mismatch = detail::pass_over_cells(problem, law, settings, r, v.data()->data(), true, system, batch);
    report.converged =
        mismatch.within(settings.tolerance) && friction_settled && !contact_changed && left <= tolerated;
    if (report.converged) break;
  }
  detail::from_batches(batch, duals);
  return report;
}

}  // namespace tremie
