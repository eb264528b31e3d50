#pragma once

// Wall terms at nodes (wall_term.hpp) in the solvers. The viscous drag of all of them is gathered once a step. The yield
// force of Coulomb's law is frozen while a step is solved and renewed from the reaction by renew_yield_forces() in
// implicit/solve.hpp. Explicit steps have their walls in explicit/nodes.hpp.

#include <algorithm>
#include <cmath>

#include "libmpm/boundary/wall_term.hpp"

namespace tremie {

/// Viscous drag of all wall terms at a node: the force pull - k v [N].
template <int D>
struct NodeDrag {
  double k = 0.0;                ///< [kg/s]
  Vec<D> pull = Vec<D>::Zero();  ///< of walls that move [N]
};

/// Viscous drag on each of n nodes, in all directions: a flat wall prescribes the normal velocity. Empty: none.
template <int D>
std::vector<NodeDrag<D>> viscous_drag(const std::vector<NodeTerm<D>>& terms, std::size_t n) {
  std::vector<NodeDrag<D>> drag;
  for (const NodeTerm<D>& t : terms) {
    if (t.viscous == 0.0) continue;
    if (drag.empty()) drag.resize(n);
    drag[t.node].k += t.viscous;
    drag[t.node].pull += t.viscous * t.velocity;
  }
  return drag;
}

/// ADMM's penalties: half the shear stiffness of the concrete next to each node, `viscosity` V_i / h^2, where `viscosity` is
/// the linear systems', mu + r, and h the term's reach. V: volume of the concrete around each node [m^3]; `system`: what
/// has add_diagonal(node, component, value).
template <int D, class System>
void add_node_stiffness_admm(const std::vector<double>& V, double viscosity, std::vector<NodeTerm<D>>& terms,
                             System& system) {
  for (NodeTerm<D>& t : terms) {
    t.stiffness = t.limit > 0.0 ? 0.5 * viscosity * V[t.node] / (t.reach * t.reach) : 0.0;
    for (int d = 0; d < D; ++d)
      if (d != t.normal_axis) system.add_diagonal(t.node, d, t.stiffness);
  }
}

template <int D>
void add_node_forces_admm(const std::vector<NodeTerm<D>>& terms, const std::vector<Vec<D>>& v,
                          Eigen::VectorXd& R) {
  for (const NodeTerm<D>& t : terms)
    R.template segment<D>(t.node * D) -= t.force + t.stiffness * (slip_velocity(t, v) - t.slip);
}

/// Newton's rounding of |w| at w = 0 [m/s].
inline constexpr double slip_rounding = 1e-5;

template <int D>
void add_node_forces_newton(const std::vector<NodeTerm<D>>& terms, const std::vector<Vec<D>>& v,
                            Eigen::VectorXd& R) {
  for (const NodeTerm<D>& t : terms) {
    const Vec<D> w = slip_velocity(t, v);
    R.template segment<D>(t.node * D) -= t.limit / std::hypot(w.norm(), slip_rounding) * w;
  }
}

/// Newton's primal-dual tangent of the rounded yield force at the slip velocity w (see newton.hpp for the yield stress's
/// twin).
template <int D>
Mat<D, D> node_tangent(const NodeTerm<D>& t, const Vec<D>& w) {
  const double rounded = std::hypot(w.norm(), slip_rounding);
  Mat<D, D> T = t.limit / rounded * Mat<D, D>::Identity();
  T -= (t.force * w.transpose() + w * t.force.transpose()) / (2.0 * rounded * rounded);
  if (t.normal_axis >= 0) {
    T.row(t.normal_axis).setZero();
    T.col(t.normal_axis).setZero();
  }
  return T;
}

template <int D>
void update_newton(const std::vector<Vec<D>>& v, const Eigen::VectorXd& dv, std::vector<NodeTerm<D>>& terms) {
  for (NodeTerm<D>& t : terms) {
    const Vec<D> w = slip_velocity(t, v);
    Vec<D> dw = dv.template segment<D>(t.node * D);
    if (t.normal_axis >= 0) dw[t.normal_axis] = 0.0;
    const double rounded = std::hypot(w.norm(), slip_rounding);
    t.force = t.limit / rounded * (w + dw) - t.force * (w.dot(dw) / (rounded * rounded));
    project_force(t);
  }
}

/// Power of the rounded yield forces [W].
template <int D>
double node_energy(const std::vector<NodeTerm<D>>& terms, const std::vector<Vec<D>>& v) {
  double energy = 0.0;
  for (const NodeTerm<D>& t : terms)
    energy += t.limit * std::hypot(slip_velocity(t, v).norm(), slip_rounding);
  return energy;
}

}  // namespace tremie
