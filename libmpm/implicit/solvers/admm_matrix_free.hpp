#pragma once

// ADMM in 3D without a matrix: the linear solves by preconditioned conjugate gradients, which go on from the last ones
// and are no more exact than the iteration needs; stresses and rates packed and updated a batch of cells at a time.

#include "libmpm/implicit/solvers/admm.hpp"
#include "libmpm/implicit/solvers/linear_system_3d.hpp"

namespace tremie {

namespace detail {

/// Viscosities of an iteration [Pa s]: its penalty, and what opposes a rate. In water that is not the
/// viscosity but the inertia, and r is as large. Measured by the viscosity the residuals r (q - d) would have
/// to be the smaller the shorter a step is, and none would be short enough to converge. The inertia is that
/// over the time in which the concrete moves some of a cell, or what a step may miss would grow as it gets
/// shorter.
struct IterationViscosities {
  double r, opposing;
};

IterationViscosities viscosities_of(const YieldProblem<ThreeD>& problem, const AdmmSettings& settings);

/// The ADMM state of cells packed in batches, and that unpacked again.
PackedAdmmState pack(const AdmmState<ThreeD>& admm_state, const Quadrature<ThreeD>& quadrature);
AdmmState<ThreeD> unpack(const YieldLaw& law, const PackedAdmmState& packed);

}  // namespace detail

/// The form of solve_admm() for large bodies in 3D.
struct MatrixFreeAdmm {
  YieldProblem<ThreeD>& problem;
  const YieldLaw& law;
  const AdmmSettings& settings;
  MatrixFreeSystem& system;
  PackedAdmmState& state;
  detail::IterationViscosities viscosities = detail::viscosities_of(problem, settings);
  double eta_system = problem.mu + viscosities.r;  ///< viscosity of the linear systems
  Eigen::VectorXd R = {};  ///< forces of stress, pressure and closed contacts at the last velocities [N]

  bool prepare();
  bool contact_changed() { return true; }  // products ask the contacts themselves
  double solve(double tolerated, std::vector<Vec<3>>& v);

  /// An error e of v that a solve leaves has rates q(e), whose square over the volume is at most its energy
  /// (r, A^-1 r), here (r, P^-1 r), over eta_system, and is worth a stress of eta_system |q(e)|: no more of either than the iteration
  /// tolerates.
  double tolerated_energy(const detail::AdmmResiduals& m) const {
    return std::min(std::pow(settings.tolerance, 2) * m.scale / eta_system,
                    eta_system * std::pow(m.tolerated_miss(settings), 2));
  }
  detail::AdmmResiduals start(const std::vector<Vec<3>>& v) { return pass(v, false); }
  detail::AdmmResiduals update(const std::vector<Vec<3>>& v) { return pass(v, true); }

 private:
  detail::AdmmResiduals pass(const std::vector<Vec<3>>& v, bool update);
};

}  // namespace tremie
