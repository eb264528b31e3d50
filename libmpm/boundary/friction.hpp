#pragma once

// Coulomb friction on flat walls as a yield term of the implicit step: energy g |u| at each node of a wall of
// FaceKind::friction, u its sliding velocity (walls stand still), g = coefficient times normal force. g is frozen while
// a step is solved and renewed from the reaction by update_normal_forces() in implicit/solve.hpp, where the coefficient
// enters. The drag of side walls is carried by the same nodes (normal_axis < 0). Explicit steps have their friction in
// explicit/nodes.hpp.

#include <algorithm>
#include <cmath>

#include "libmpm/boundary/contact.hpp"

namespace tremie {

/// Newton's rounding of |u| at u = 0 [m/s].
inline constexpr double friction_rounding = 1e-5;

/// ADMM's penalties: half the shear stiffness of the concrete next to each node, `viscosity` V_i / h^2, where `viscosity` is
/// the linear systems', mu + r. V: volume of the concrete around each node [m^3]; `system`: what has
/// add_diagonal(node, component, value).
template <int D, class System>
void add_friction_stiffness_admm(const ActiveGrid<D>& grid, const std::vector<double>& V, double viscosity,
                                 std::vector<FrictionNode<D>>& friction, System& system) {
  for (FrictionNode<D>& f : friction) {
    // A node that side walls hold brings their own length, the distance over which its drag acts.
    const double h = f.normal_axis >= 0 ? grid.axes[f.normal_axis].h : f.reach;
    f.stiffness = f.limit > 0.0 ? 0.5 * viscosity * V[f.node] / (h * h) : 0.0;
    for (int d = 0; d < D; ++d)
      if (d != f.normal_axis) system.add_diagonal(f.node, d, f.stiffness);
  }
}

template <int D>
void add_friction_forces_admm(const std::vector<FrictionNode<D>>& friction, const std::vector<Vec<D>>& v,
                              Eigen::VectorXd& R) {
  for (const FrictionNode<D>& f : friction)
    R.template segment<D>(f.node * D) -= f.force + f.stiffness * (sliding(f, v) - f.slip);
}

/// One update of the split sliding velocities; true when all agree with the grid's within the tolerance.
template <int D>
bool update_friction_admm(std::vector<FrictionNode<D>>& friction, const std::vector<Vec<D>>& v,
                          double over_relaxation, double tolerance) {
  double residuals = 0.0, scale = 0.0;
  for (FrictionNode<D>& f : friction) {
    if (f.stiffness == 0.0) continue;  // nothing presses on it
    const Vec<D> u = sliding(f, v);
    const Vec<D> a = f.force + f.stiffness * (over_relaxation * u + (1.0 - over_relaxation) * f.slip);
    const double a_norm = a.norm();
    const Vec<D> force = a_norm > f.limit ? Vec<D>(f.limit / a_norm * a) : a;
    const Vec<D> slip = (a - force) / f.stiffness;
    residuals +=
        (f.stiffness * f.stiffness) * std::max((u - slip).squaredNorm(), (slip - f.slip).squaredNorm());
    scale += f.limit * f.limit;
    f.force = force;
    f.slip = slip;
  }
  return residuals <= tolerance * tolerance * scale;
}

template <int D>
void add_friction_forces(const std::vector<FrictionNode<D>>& friction, const std::vector<Vec<D>>& v,
                         Eigen::VectorXd& R) {
  for (const FrictionNode<D>& f : friction) {
    const Vec<D> u = sliding(f, v);
    R.template segment<D>(f.node * D) -= f.limit / std::hypot(u.norm(), friction_rounding) * u;
  }
}

/// Newton's primal-dual tangent of the rounded friction (see newton.hpp for the yield part's twin).
template <int D>
Mat<D, D> friction_tangent(const FrictionNode<D>& f, const Vec<D>& u) {
  const double rounded = std::hypot(u.norm(), friction_rounding);
  Mat<D, D> T = f.limit / rounded * Mat<D, D>::Identity();
  T -= (f.force * u.transpose() + u * f.force.transpose()) / (2.0 * rounded * rounded);
  if (f.normal_axis >= 0) {
    T.row(f.normal_axis).setZero();
    T.col(f.normal_axis).setZero();
  }
  return T;
}

template <int D>
void update_friction_newton(std::vector<FrictionNode<D>>& friction, const std::vector<Vec<D>>& v,
                            const Eigen::VectorXd& dv) {
  for (FrictionNode<D>& f : friction) {
    const Vec<D> u = sliding(f, v);
    Vec<D> du = dv.template segment<D>(f.node * D);
    if (f.normal_axis >= 0) du[f.normal_axis] = 0.0;
    const double rounded = std::hypot(u.norm(), friction_rounding);
    f.force = f.limit / rounded * (u + du) - f.force * (u.dot(du) / (rounded * rounded));
    const double size = f.force.norm();
    if (size > f.limit) f.force *= f.limit / size;
  }
}

template <int D>
double friction_energy(const std::vector<FrictionNode<D>>& friction, const std::vector<Vec<D>>& v) {
  double energy = 0.0;
  for (const FrictionNode<D>& f : friction)
    energy += f.limit * std::hypot(sliding(f, v).norm(), friction_rounding);
  return energy;
}

}  // namespace tremie
