#pragma once

// ADMM with a Cholesky factor of the assembled system: one factor a step, kept while no contact changes. Stresses and
// rates are kept quadrature point by quadrature point.

#include "libmpm/implicit/solvers/admm.hpp"

namespace tremie {

namespace detail {

/// The local step: new rates d and stresses s at the velocities v, and what they miss.
template <class Geometry, class Law>
AdmmResiduals update_stress_and_rate(const YieldProblem<Geometry>& problem, const Law& law,
                                     const AdmmSettings& settings, double r,
                                     const std::vector<Vec<Geometry::dim>>& v,
                                     AdmmState<Geometry>& admm_state) {
  constexpr int n = power(2, Geometry::dim);
  const auto& quad = problem.quadrature;
  std::vector<AdmmResiduals> part(quad.V.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int k = 0; k < n; ++k) {
      const double tau_y = quad.tau_y[c][k], V = quad.V[c][k];
      auto& d = admm_state.rate[c][k];
      auto& s = admm_state.stress[c][k];
      const auto q = strain_rate(problem, v, c, k);
      const Vec<Geometry::n_strain> a =
          s + r * (settings.over_relaxation * q + (1.0 - settings.over_relaxation) * d);
      const double a_norm = a.norm();
      const Vec<Geometry::n_strain> d_new =
          a_norm > 0.0 ? Vec<Geometry::n_strain>(law.prox(a_norm, tau_y, r) / a_norm * a)
                       : Vec<Geometry::n_strain>(0.0 * a);
      part[c].primal += V * (r * (q - d_new)).squaredNorm();
      part[c].dual += V * (r * (d_new - d)).squaredNorm();
      part[c].scale += V * std::pow(tau_y + problem.eta * q.norm() + no_stress, 2);
      part[c].missed += V * (q - d_new).squaredNorm();
      part[c].rate += V * q.squaredNorm();
      part[c].volume += V;
      s = a - r * d_new;
      d = d_new;
    }
  AdmmResiduals sum;
  for (const AdmmResiduals& m : part) sum.add(m);
  return sum;
}

}  // namespace detail

template <class Geometry>
struct FactorisedAdmm {
  static constexpr int D = Geometry::dim;
  using Strain = Vec<Geometry::n_strain>;
  YieldProblem<Geometry>& problem;
  const YieldLaw& law;
  const AdmmSettings& settings;
  BlockSystem<D>& system;
  AdmmState<Geometry>& state;
  double r = detail::penalty(problem, settings.penalty);

  bool prepare() {
    set_point_stiffness_admm(problem.mu + r, problem.bars);
    assemble(
        problem, [&](int c, int k) { return problem.mu_at(c, k) + r; }, system);
    if (!problem.wall_nodes.empty())
      add_node_stiffness_admm<D>(volumes_around_nodes(problem), problem.mu + r, problem.wall_nodes, system);
    system.fix(problem.fixed);
    return system.factorise();
  }
  bool contact_changed() { return prepare(); }

  double solve(double, std::vector<Vec<D>>& v) {
    const auto stress = [&](int c, int k, const Strain& q) -> Strain {
      return problem.mu_at(c, k) * q + state.stress[c][k] + r * (q - state.rate[c][k]);
    };
    Eigen::VectorXd R = residual(problem, v, stress);
    add_node_forces_admm<D>(problem.wall_nodes, v, R);
    mask(problem.fixed, R);
    const Eigen::VectorXd dv = system.solve(R);
    for (int i = 0; i < problem.grid.n_nodes(); ++i) v[i] += dv.segment<D>(i * D);
    fill_mirrors<D>(problem.grid, v);
    return 0.0;
  }

  // A factor leaves nothing, so the residuals before the first solve are not asked for.
  detail::AdmmResiduals start(const std::vector<Vec<D>>&) const { return {}; }
  double tolerated_energy(const detail::AdmmResiduals&) const { return 0.0; }
  detail::AdmmResiduals update(const std::vector<Vec<D>>& v) {
    return std::visit(
        [&](const auto& l) { return detail::update_stress_and_rate(problem, l, settings, r, v, state); },
        law);
  }
};

}  // namespace tremie
