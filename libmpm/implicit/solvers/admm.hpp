#pragma once

// Alternating direction method of multipliers for the yield problem (Glowinski; Boyd et al. 2011). The yield part sees
// a strain rate d of its own at every quadrature point, tied to q(v) by a stress s and a penalty r,
//
//   v:  M (v - v*)/dt + bulk + contact + B' V [mu q(v) + s + r (q(v) - d)] = 0     one linear solve, one matrix a step
//   d:  a = s + r (rho q + (1 - rho) d),   d <- prox(|a|) a/|a|,   s <- a - r d    closed form, point by point
//
// The exact Bingham law needs no regularisation: |s| <= tau_y always, and d = 0 exactly where it does not yield.
//
// solve_admm() is the iteration. How a batch of quadrature points is visited and how the linear system is solved are
// two forms of one interface: admm_factorised.hpp (a Cholesky factor, any geometry) and admm_matrix_free.hpp
// (preconditioned conjugate gradients, 3D).

#include <algorithm>
#include <cmath>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/implicit/problem/yield_problem.hpp"

namespace tremie {

struct AdmmSettings {
  double tolerance = 1e-3;  ///< of the stress residuals, relative to the stresses
  int max_iterations = 1000;
  double over_relaxation = 1.6;  ///< rho
  double penalty = 3.0;          ///< r over the problem's eta, at least
  // Where the linear systems are solved by iteration, in 3D:
  double penalty_by_iteration =
      1.5;  ///< r over eta, at least: softer, for the systems are then better conditioned
  double solve_reduction = 0.5;       ///< of the residual in one solve, in the energy norm
  double solve_share = 1.0;           ///< of the tolerated residuals (squared) that a solve may leave
  int direct_below = 2000;            ///< unknowns; smaller systems are factorised
  double most_band_operations = 1e9;  ///< of a factor of the pressures' matrix; beyond, by iteration
  double most_bulk_stiffness = 1e4;   ///< K dt over mu + r in a system; the rest by multipliers
  double inertia_from = 10.0;         ///< eta: a cell's inertia beyond this is in the scale of the stresses,
  double inertia_over = 0.3;          ///< over the time of a move by so many cells, or the step if longer
  /// A rate at which the concrete is at rest [1/s]: half a millimetre a second over half a decimetre. What drives it more
  /// slowly, as a vane may, must say so.
  double rate_at_rest = 0.01;
};

namespace detail {

/// So little is no stress of a concrete [Pa]: the scale where nothing yields and nothing moves.
inline constexpr double no_stress = 1e-3;

inline constexpr double rate_at_rest = AdmmSettings{}.rate_at_rest;  ///< [1/s]

/// Squares of the primal and dual residuals and of the stress scale, of the rates and of what they miss,
/// weighted by volume; what the pressures miss, as the energy of a solve [W].
struct AdmmResiduals {
  double primal = 0.0, dual = 0.0, scale = 0.0, missed = 0.0, rate = 0.0, volume = 0.0, pressure = 0.0;

  void add(const AdmmResiduals& m) {
    primal += m.primal, dual += m.dual, scale += m.scale;
    missed += m.missed, rate += m.rate, volume += m.volume, pressure += m.pressure;
  }
  /// How much of the rates may be missed, a tenth and what counts as rest: root of volume times square.
  double tolerated_miss(const AdmmSettings& settings) const {
    return 0.1 * std::sqrt(rate) + settings.rate_at_rest * std::sqrt(volume);
  }
  /// In the stresses, and in the rates: where the yield stress dwarfs r times the rate, the whole rate could
  /// be missed within a tolerance on the stress.
  bool within(const AdmmSettings& settings) const {
    return std::max(primal, dual) <= settings.tolerance * settings.tolerance * scale &&
           std::sqrt(missed) <= tolerated_miss(settings);
  }
};

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
  return std::max({viscosities * problem.eta, inertial_viscosity(problem, problem.dt),
                   mean_yield_stress(problem) / fastest_rate});
}

}  // namespace detail

/// Solves the yield problem from the guesses v and that of `form`, which it overwrites with the solution. A form states
///   bool prepare()                       sets up the linear system; false where it is not definite
///   AdmmResiduals start(v)               at the guess
///   double tolerated_energy(residuals)   of the error that a linear solve may leave [W]
///   double solve(tolerated, v)           the step of v; returns the energy of the error that it left [W]
///   AdmmResiduals update(v)              the step of d and s at every quadrature point
///   bool contact_changed()               renews the linear system; false where it is not definite
template <class Geometry, class Form>
SolveReport solve_admm(YieldProblem<Geometry>& problem, const AdmmSettings& settings, Form& form,
                       std::vector<Vec<Geometry::dim>>& v) {
  constexpr int D = Geometry::dim;
  SolveReport report;
  if (!form.prepare()) return report;
  detail::AdmmResiduals residuals = form.start(v);
  for (; report.iterations < settings.max_iterations; ++report.iterations) {
    const double tolerated = form.tolerated_energy(residuals);
    const double left = form.solve(tolerated, v);
    const bool contact_changed = update_active<D>(problem.contact, problem.grid.cell_nodes, v);
    const bool nodes_settled = update_admm<D>(problem.grid.cell_nodes, v, settings.over_relaxation,
                                              settings.tolerance, problem.wall_nodes);
    const bool bars_settled = update_admm<D>(problem.grid.cell_nodes, v, settings.over_relaxation,
                                             settings.tolerance, problem.bars);
    set_targets(problem.bars);
    residuals = form.update(v);
    if (contact_changed && !form.contact_changed()) return report;
    report.converged =
        residuals.within(settings) && nodes_settled && bars_settled && !contact_changed &&
        std::max(left, residuals.pressure) <= std::min(tolerated, form.tolerated_energy(residuals));
    if (report.converged) break;
  }
  return report;
}

}  // namespace tremie
