#pragma once

// Wall terms at points (wall_term.hpp) in the solvers: the linear systems see a penalty towards a velocity.

#include <span>

#include "libmpm/boundary/wall_term.hpp"
#include "libmpm/linear/block_system.hpp"

namespace tremie {

/// Force of the penalty on the concrete at a point [N].
template <int D>
Vec<D> wall_force(const PointTerm<D>& t, const CellNodes<D>& cell_nodes, const std::vector<Vec<D>>& v) {
  Vec<D> u = Vec<D>::Zero();
  for (int i = 0; i < power(3, D); ++i) u += t.N[i] * v[cell_nodes[t.cell][i]];
  return t.penalty * (t.target - u);
}

template <int D>
void add_penalty_forces(std::span<const PointTerm<D>> terms, const CellNodes<D>& cell_nodes,
                        const std::vector<Vec<D>>& v, Eigen::VectorXd& R) {
  for (const PointTerm<D>& t : terms) {
    const Vec<D> force = wall_force<D>(t, cell_nodes, v);
    for (int i = 0; i < power(3, D); ++i) R.segment<D>(cell_nodes[t.cell][i] * D) += t.N[i] * force;
  }
}

template <int D>
void add_penalty_stiffness(std::span<const PointTerm<D>> terms, BlockSystem<D>& system) {
  for (const PointTerm<D>& t : terms) {
    typename BlockSystem<D>::CellMatrix K;
    for (int i = 0; i < power(3, D); ++i)
      for (int j = 0; j < power(3, D); ++j)
        K.template block<D, D>(i * D, j * D) = t.N[i] * t.N[j] * t.penalty;
    system.add_cell(t.cell, K);
  }
}

template <int D>
double penalty_energy(std::span<const PointTerm<D>> terms, const CellNodes<D>& cell_nodes,
                      const std::vector<Vec<D>>& v) {
  double energy = 0.0;
  for (const PointTerm<D>& t : terms) {
    Vec<D> u = t.target;
    for (int i = 0; i < power(3, D); ++i) u -= t.N[i] * v[cell_nodes[t.cell][i]];
    energy += 0.5 * u.dot(t.penalty * u);
  }
  return energy;
}

/// Velocities towards which the penalties of terms that yield pull: viscous drag, yield force and split slip in one.
template <int D>
void set_targets(std::vector<PointTerm<D>>& terms) {
  for (PointTerm<D>& t : terms) {
    t.target = t.velocity;
    if (t.stiffness > 0.0)
      t.target += t.scale.inverse() * (t.stiffness * t.slip - t.force) / (t.stiffness + t.viscous);
  }
}

/// ADMM's penalties of terms that yield: to the viscous drag as `viscosity`, mu + r, is to mu.
template <int D>
void set_point_stiffness_admm(double viscosity, std::vector<PointTerm<D>>& terms) {
  for (PointTerm<D>& t : terms) {
    t.stiffness = t.limit > 0.0 ? viscosity * t.reach : 0.0;
    t.penalty = (t.stiffness + t.viscous) * t.scale * t.scale;
  }
  set_targets(terms);
}

}  // namespace tremie
