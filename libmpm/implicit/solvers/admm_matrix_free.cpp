#include "libmpm/implicit/solvers/admm_matrix_free.hpp"

namespace tremie {

namespace detail {

PackedAdmmState pack(const AdmmState<ThreeD>& admm_state, const Quadrature<ThreeD>& quadrature) {
  const int n_cells = static_cast<int>(admm_state.stress.size());
  PackedAdmmState packed = zero_admm_state(n_cells);
  for (int c = 0; c < n_cells; ++c)
    for (int k = 0; k < 8; ++k) {
      PackedAdmmState::Batch& b = packed.batch[c / batch_size];
      b.tau_y[k][c % batch_size] = quadrature.tau_y[c][k];
      for (int j = 0; j < 5; ++j)
        b.a[k][j][c % batch_size] = admm_state.stress[c][k][j] + packed.r * admm_state.rate[c][k][j];
    }
  return packed;
}

AdmmState<ThreeD> unpack(const YieldLaw& law, const PackedAdmmState& packed) {
  const int n_cells = static_cast<int>(packed.batch.size()) * batch_size;
  AdmmState<ThreeD> admm_state;
  admm_state.resize(n_cells);
  for (int c = 0; c < n_cells; ++c)
    for (int k = 0; k < 8; ++k) {
      const PackedAdmmState::Batch& b = packed.batch[c / batch_size];
      admm_state.stress[c][k] = stress_of(law, packed, c, k);
      for (int j = 0; j < 5; ++j)
        admm_state.rate[c][k][j] = (b.a[k][j][c % batch_size] - admm_state.stress[c][k][j]) / packed.r;
    }
  return admm_state;
}

/// Single precision forgets the viscosity beside a modulus that is millions of times stiffer over a step. The
/// systems then have no more of it than `most` of K dt over the viscosity eta_system, and the rest is made up as in
/// an augmented Lagrangian (Fortin, Glowinski 1983): p = p_offset - K dt div v, and p_offset moves to where p
/// is what the mix's modulus makes of div v (update_multiplier()).
void lower_modulus(double most, double eta_system, YieldProblem<ThreeD>& problem) {
  const double ratio = problem.K * problem.dt / eta_system;
  if (ratio <= most) return;
  if (problem.p_offset.empty()) problem.p_offset = problem.quadrature.p;
  problem.K_share *= most / ratio, problem.K *= most / ratio;
}

/// Moves the offset of cell c, whose pressure is p, and returns by how much: K_share of what p misses of the
/// pressure that the mix's modulus makes of the same divergence.
double update_multiplier(int c, double p, YieldProblem<ThreeD>& problem) {
  const double p_0 = problem.quadrature.p[c], before = problem.p_offset[c];
  problem.p_offset[c] = p_0 + (1.0 - problem.K_share) * (p - p_0);
  return problem.p_offset[c] - before;
}

/// Pressures of a batch of cells that fall by K dt div v. Moves their offsets on if asked to, and adds what
/// they missed, as the energy of its divergence at the mix's modulus, to `missed` [W].
Lanes<double> pressures_of(int batch, const Lanes<double>& fall, bool update, YieldProblem<ThreeD>& problem,
                           double& missed) {
  const int last = problem.grid.n_cells() - 1;
  Lanes<double> p;
  for (int l = 0; l < batch_size; ++l)
    p[l] = problem.offset(std::min(batch * batch_size + l, last)) - fall[l];
  if (problem.p_offset.empty() || !update) return p;
  for (int l = 0, c = batch * batch_size; l < batch_size && c <= last; ++l, ++c) {
    const double by = update_multiplier(c, p[l], problem);
    p[l] += by;
    missed += problem.quadrature.V_cell[c] * by * by / (problem.K_share * problem.K * problem.dt);
  }
  return p;
}

/// Speed of the nodes before the step, with what gravity gives them in it: root mean square by mass [m/s].
double mean_speed(const YieldProblem<ThreeD>& problem) {
  double mass = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < problem.nodes.mass.size(); ++i) {
    mass += problem.nodes.mass[i];
    sum += problem.nodes.mass[i] * problem.nodes.v[i].squaredNorm();
  }
  return mass > 0.0 ? std::sqrt(sum / mass) : 0.0;
}

IterationViscosities viscosities_of(const YieldProblem<ThreeD>& problem, const AdmmSettings& settings) {
  const double speed = mean_speed(problem), h = problem.grid.cell_size_min();
  const double moved = settings.inertia_over * h / std::max(speed, 1e-300);
  const double inertia = inertial_viscosity(problem, std::max(problem.dt, moved));
  return {penalty(problem, settings.penalty_by_iteration),
          problem.eta + std::max(0.0, inertia - settings.inertia_from * problem.eta)};
}

/// One pass over the cells at the velocities v: updates the ADMM state and pressures if asked to, adds up the
/// residuals, and the forces R of stress, pressure and closed contacts on the nodes.
template <class Law>
AdmmResiduals pass_over_cells(YieldProblem<ThreeD>& problem, const Law& law, const AdmmSettings& settings,
                              const IterationViscosities& viscosities, const std::vector<Vec<3>>& v,
                              bool update, MatrixFreeSystem& system, PackedAdmmState& admm_state,
                              Eigen::VectorXd& R) {
  const double mu = problem.mu, rho = settings.over_relaxation, bulk = problem.K * problem.dt;
  const double r = viscosities.r, opposing = viscosities.opposing;
  const auto& quad = problem.quadrature;
  const int last = problem.grid.n_cells() - 1;
  std::vector<AdmmResiduals> part(admm_state.batch.size());
  R.resize(3 * problem.grid.n_nodes());
  const auto give_batch = [&](int b, double* to) {
    QuadratureTensors<double> G;
    system.batches.gradients(b, v.data()->data(), G);
    const BatchVolumes<double> vol = batch_volumes(quad, b);
    PackedAdmmState::Batch& own = admm_state.batch[b];
    Lanes<double> mean = Lanes<double>::Zero(), missed = mean, moved = mean, scale = mean, rate = mean,
                  volume = mean;
    double missed_p = 0.0;
    for (int k = 0; k < 8; ++k) mean += vol.V[k] * (G.g[0][0][k] + G.g[1][1][k] + G.g[2][2][k]);
    mean *= vol.inverse_cell;
    const Lanes<double> p = pressures_of(b, bulk * mean, update, problem, missed_p) + problem.zeta * mean;
    for (int k = 0; k < 8; ++k) {
      Lanes<double> q[5], s[5], d[5], div, stress[5], tau_y;
      strain_at(G, k, q, div);
      for (int l = 0; l < batch_size; ++l) tau_y[l] = quad.tau_y[std::min(b * batch_size + l, last)][k];
      unpack_stress_and_rate(law, own.a[k], own.tau_y[k], admm_state.r, s, d);
      if (update) {
        Lanes<double>(&a)[5] = own.a[k];
        Lanes<double> s_new[5], d_new[5];
        for (int j = 0; j < 5; ++j) a[j] = s[j] + r * (rho * q[j] + (1.0 - rho) * d[j]);
        unpack_stress_and_rate(law, a, tau_y, r, s_new, d_new);
        own.tau_y[k] = tau_y;
        for (int j = 0; j < 5; ++j) {
          missed += vol.V[k] * (q[j] - d_new[j]).square();
          moved += vol.V[k] * (d_new[j] - d[j]).square();
          s[j] = s_new[j], d[j] = d_new[j];
        }
      }
      const Lanes<double> gamma_dot = norm(q);
      scale += vol.V[k] * (tau_y + opposing * gamma_dot + no_stress).square();
      rate += vol.V[k] * gamma_dot.square();
      volume += vol.V[k];
      for (int j = 0; j < 5; ++j) stress[j] = -vol.V[k] * (mu * q[j] + s[j] + r * (q[j] - d[j]));
      stress_at<double>(stress, vol.V[k] * (p - problem.zeta * div), k, G);
    }
    system.batches.scatter(b, G, to);
    part[b] = {.primal = r * r * sum_of(missed),
               .dual = r * r * sum_of(moved),
               .scale = sum_of(scale),
               .missed = sum_of(missed),
               .rate = sum_of(rate),
               .volume = sum_of(volume),
               .pressure = missed_p};
  };
  const auto give = [&](int chunk, double* to) {
    for (int b = system.batches.first_batch(chunk); b < system.batches.last_batch(chunk); ++b)
      give_batch(b, to);
    for_each_contact(problem.contact, system.batches.reduction(), chunk, [&](const ContactPoint<3>& c) {
      add_at_contact(c, problem.grid.cell_nodes[c.cell],
                     c.stiffness * (c.target - normal_velocity(c, problem.grid.cell_nodes, v)), to);
    });
  };
#pragma omp parallel
  system.batches.reduction().sweep_in_region<double>(system.forces, give, [&](int i) {
    R.segment<3>(3 * i) = system.batches.reduction().sum_at<double, 3>(i, system.forces);
  });
  if (update) admm_state.r = r;
  AdmmResiduals sum;
  for (const AdmmResiduals& m : part) sum.add(m);
  return sum;
}

/// Adds all other forces at v to what pass_over_cells() found.
void residual_3d(const YieldProblem<ThreeD>& problem, const std::vector<Vec<3>>& v, Eigen::VectorXd& R) {
#pragma omp parallel for schedule(static)
  for (int i = 0; i < problem.grid.n_nodes(); ++i)
    R.segment<3>(3 * i) = problem.nodes.mass[i] / problem.dt * (problem.nodes.v[i] - v[i]) -
                          (problem.drag.empty() ? 0.0 : problem.drag[i].k) * v[i] + R.segment<3>(3 * i);
  for (std::size_t i = 0; i < problem.drag.size(); ++i)
    R.segment<3>(3 * static_cast<Eigen::Index>(i)) += problem.drag[i].pull;
  for (const auto& terms : problem.points()) add_penalty_forces<3>(terms, problem.grid.cell_nodes, v, R);
  add_node_forces_admm<3>(problem.wall_nodes, v, R);
  fold_mirrors<3>(problem.grid, R);
  mask(problem.fixed, R);
}

}  // namespace detail

bool MatrixFreeAdmm::prepare() {
  detail::lower_modulus(settings.most_bulk_stiffness, eta_system, problem);
  set_point_stiffness_admm(eta_system, problem.bars);
  system.set_up(problem, settings.most_band_operations);
  return system.prepare(problem, eta_system);
}

double MatrixFreeAdmm::solve(double tolerated, std::vector<Vec<3>>& v) {
  detail::residual_3d(problem, v, R);
  return system.solve(problem, R,
                      {.reduction = settings.solve_reduction, .enough = settings.solve_share * tolerated}, v);
}

detail::AdmmResiduals MatrixFreeAdmm::pass(const std::vector<Vec<3>>& v, bool update) {
  return std::visit(
      [&](const auto& l) {
        return detail::pass_over_cells(problem, l, settings, viscosities, v, update, system, state, R);
      },
      law);
}

}  // namespace tremie
