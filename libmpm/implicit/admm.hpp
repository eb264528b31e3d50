#pragma once

// Alternating directions for the yield problem (Glowinski; Boyd et al. 2011): the yield part sees a strain
// rate d of its own at every Gauss place, tied to q(v) by a stress s and a penalty r,
//
//   v:  M (v - v*)/dt + bulk + contact + B' V [mu q(v) + s + r (q(v) - d)] = 0       one linear solve, one
//   matrix a step d:  a = s + r (rho q + (1 - rho) d),   d <- prox(|a|) a/|a|,   s <- a - r d      closed
//   form, place by place
//
// The exact Bingham law needs no regularisation: |s| <= tau_y always, and d = 0 exactly where it does not
// yield.

#include <algorithm>
#include <cmath>

#include "libmpm/boundary/friction.hpp"
#include "libmpm/implicit/problem/yield_problem.hpp"

namespace tremie {

struct AdmmSettings {
  double tolerance = 1e-3;  ///< of the stress residuals, relative to the stresses
  int max_iterations = 1000;
  double over_relaxation = 1.6;  ///< rho
  double penalty = 3.0;          ///< r / mu
  // Where the linear systems are solved by iteration, in space:
  double penalty_by_iteration = 1.5;  ///< r / mu: softer, for the systems are then better conditioned
  double solve_reduction = 0.5;       ///< of the residual in one solve, in the energy norm
  double solve_share = 1.0;           ///< of the tolerated residuals (squared) that a solve may leave
  int direct_below = 2000;            ///< unknowns; smaller systems are factorised
  double most_band_operations = 1e9;  ///< of a factor of the pressures' matrix; beyond, by iteration
  double most_bulk_stiffness = 1e4;   ///< K dt over mu + r in a system; the rest by multipliers
  double inertia_from = 10.0;         ///< mu: a cell's inertia beyond this is in the scale of the stresses,
  double inertia_over = 0.3;          ///< over the time of a move by so many cells, or the step if longer
};

namespace detail {

/// So little is no stress of a concrete [Pa]: the scale where nothing yields and nothing moves.
inline constexpr double no_stress = 1e-3;

/// Hardly any place of a test shears faster for long [1/s].
inline constexpr double fastest_rate = 100.0;

/// A rate at which the concrete is at rest [1/s]: half a millimetre a second over half a decimetre.
inline constexpr double rate_at_rest = 0.01;

/// Squares of the primal and dual residuals and of the stress scale, of the rates and of what they miss,
/// weighted by volume; what the pressures miss, as the energy of a solve [W].
struct AdmmResiduals {
  double primal = 0.0, dual = 0.0, scale = 0.0, missed = 0.0, rate = 0.0, volume = 0.0, pressure = 0.0;

  void add(const AdmmResiduals& m) {
    primal += m.primal, dual += m.dual, scale += m.scale;
    missed += m.missed, rate += m.rate, volume += m.volume, pressure += m.pressure;
  }
  /// How much of the rates may be missed, a tenth and what counts as rest: root of volume times square.
  double tolerated_miss() const { return 0.1 * std::sqrt(rate) + rate_at_rest * std::sqrt(volume); }
  /// In the stresses, and in the rates: where the yield stress dwarfs r times the rate, the whole rate could
  /// be missed within a tolerance on the stress.
  bool within(double tolerance) const {
    return std::max(primal, dual) <= tolerance * tolerance * scale && std::sqrt(missed) <= tolerated_miss();
  }
};

template <class Geometry, class Law>
AdmmResiduals update_stress_and_rate(const YieldProblem<Geometry>& problem, const Law& law, const AdmmSettings& settings,
                      double r, const std::vector<Vec<Geometry::dim>>& v, AdmmState<Geometry>& admm_state) {
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
      const Vec<Geometry::n_strain> d_new = a_norm > 0.0
                                             ? Vec<Geometry::n_strain>(law.prox(a_norm, tau_y, r) / a_norm * a)
                                             : Vec<Geometry::n_strain>(0.0 * a);
      part[c].primal += V * (r * (q - d_new)).squaredNorm();
      part[c].dual += V * (r * (d_new - d)).squaredNorm();
      part[c].scale += V * std::pow(tau_y + problem.mu * q.norm() + no_stress, 2);
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

/// Volume of the concrete around each node: an equal share of every cell that it touches [m^3].
template <class Geometry>
std::vector<double> volumes_around_nodes(const YieldProblem<Geometry>& problem) {
  std::vector<double> V(problem.grid.node_index.size(), 0.0);
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int i : problem.grid.cell_nodes[c]) V[i] += problem.quadrature.V_cell[c] / power(3, Geometry::dim);
  fold_mirrors<Geometry::dim>(problem.grid, V);
  return V;
}

/// Mean yield stress [Pa], by volume.
template <class Geometry>
double mean_yield_stress(const YieldProblem<Geometry>& problem) {
  double sum = 0.0, volume = 0.0;
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int k = 0; k < power(2, Geometry::dim); ++k) {
      sum += problem.quadrature.V[c][k] * problem.quadrature.tau_y[c][k];
      volume += problem.quadrature.V[c][k];
    }
  return volume > 0.0 ? sum / volume : 0.0;
}

/// What the inertia of a cell opposes to its shear over a time t, as a viscosity [Pa s]: rho h^2/t.
template <class Geometry>
double inertial_viscosity(const YieldProblem<Geometry>& problem, double t) {
  double mass = 0.0, volume = 0.0;
  for (double m : problem.nodes.mass) mass += m;
  for (double V : problem.quadrature.V_cell) volume += V;
  const double h = problem.grid.cell_size_min();
  return mass / volume * h * h / t;
}

/// The penalty r [Pa s]: a multiple of the viscosity, or the inertia of a cell or the yield stress over the
/// fastest rate of a test where that is stiffer. A smaller one would hardly move the stresses in an
/// iteration, and the residuals r (q - d) would look converged from the start.
template <class Geometry>
double penalty(const YieldProblem<Geometry>& problem, double viscosities) {
  return std::max({viscosities * problem.mu, inertial_viscosity(problem, problem.dt),
                   mean_yield_stress(problem) / fastest_rate});
}

}  // namespace detail

/// Solves the yield problem by ADMM from the guesses v and ADMM state, which it overwrites with the solution.
template <class Geometry, class Law>
SolveReport solve_admm(YieldProblem<Geometry>& problem, const Law& law, const AdmmSettings& settings,
                       BlockSystem<Geometry::dim>& system, std::vector<Vec<Geometry::dim>>& v,
                       AdmmState<Geometry>& admm_state) {
  constexpr int D = Geometry::dim;
  const double r = detail::penalty(problem, settings.penalty);
  const auto stiffness = [&](int, int) { return problem.mu + r; };
  const auto stress = [&](int c, int k, const Vec<Geometry::n_strain>& q) -> Vec<Geometry::n_strain> {
    return problem.mu * q + admm_state.stress[c][k] + r * (q - admm_state.rate[c][k]);
  };
  const auto factorise = [&] {
    assemble(problem, stiffness, system);
    if (!problem.friction.empty())
      add_friction_stiffness_admm<D>(problem.grid, detail::volumes_around_nodes(problem), problem.mu + r,
                                     problem.friction, system);
    system.fix(problem.fixed);
    return system.factorise();
  };
  SolveReport report;
  if (!factorise()) return report;
  for (; report.iterations < settings.max_iterations; ++report.iterations) {
    Eigen::VectorXd R = residual(problem, v, stress);
    add_friction_forces_admm<D>(problem.friction, v, R);
    mask(problem.fixed, R);
    const Eigen::VectorXd dv = system.solve(R);
    for (int i = 0; i < problem.grid.n_nodes(); ++i) v[i] += dv.segment<D>(i * D);
    fill_mirrors<D>(problem.grid, v);
    const bool contact_changed = update_active<D>(problem.contact, problem.grid.cell_nodes, v);
    const bool friction_settled =
        update_friction_admm<D>(problem.friction, v, settings.over_relaxation, settings.tolerance);
    const auto residuals = detail::update_stress_and_rate(problem, law, settings, r, v, admm_state);
    if (contact_changed && !factorise()) return report;
    report.converged = residuals.within(settings.tolerance) && friction_settled && !contact_changed;
    if (report.converged) break;
  }
  return report;
}

}  // namespace tremie
