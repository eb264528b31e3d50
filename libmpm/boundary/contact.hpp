#pragma once

// Contact with moving rigid walls, as a term of the step's convex problem. Such a wall acts through the points next to
// it: point p may not come closer than its own half spacing,
//   n.(v(x_p) - v_wall) >= (gap_min - gap_p) / dt,
// one-sided, so the concrete is free to separate; no friction along it.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/linear/block_system.hpp"

namespace tremie {

/// A material point that may touch a moving rigid wall.
template <int D>
struct ContactPoint {
  int cell = 0;
  bool active = false;
  std::array<std::array<double, 3>, D> along;  ///< shape values in that cell, direction by direction
  Vec<D> normal;                               ///< from the wall into the concrete
  double target = 0.0;                         ///< least normal velocity [m/s]
  double stiffness = 0.0;                      ///< penalty [kg/s]

  /// Of all nodes.
  std::array<double, power(3, D)> shape() const {
    std::array<double, power(3, D)> N;
    for (int k = 0; k < power(3, D); ++k) {
      const Index<D> o = local_offset<D>(k);
      N[k] = 1.0;
      for (int d = 0; d < D; ++d) N[k] *= along[d][o[d]];
    }
    return N;
  }
};

template <int D>
double normal_velocity(const ContactPoint<D>& c, const CellNodes<D>& cell_nodes,
                       const std::vector<Vec<D>>& v) {
  const auto N = c.shape();
  Vec<D> u = Vec<D>::Zero();
  for (int i = 0; i < power(3, D); ++i) u += N[i] * v[cell_nodes[c.cell][i]];
  return c.normal.dot(u);
}

/// The same in 3D, one direction at a time.
inline double normal_velocity(const ContactPoint<3>& c, const CellNodes<3>& cell_nodes,
                              const std::vector<Vec<3>>& v) {
  const std::array<int, 27>& nodes = cell_nodes[c.cell];
  Vec<3> u = Vec<3>::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    Vec<3> plane = Vec<3>::Zero();
    for (std::size_t j = 0; j < 3; ++j) {
      const int* line = &nodes[9 * i + 3 * j];
      plane += c.along[1][j] *
               (c.along[2][0] * v[line[0]] + c.along[2][1] * v[line[1]] + c.along[2][2] * v[line[2]]);
    }
    u += c.along[0][i] * plane;
  }
  return c.normal.dot(u);
}

/// Closes contacts that are violated and opens those that would pull; true if any changed.
template <int D>
bool update_active(std::vector<ContactPoint<D>>& contact, const CellNodes<D>& cell_nodes,
                   const std::vector<Vec<D>>& v) {
  bool changed = false;
#pragma omp parallel for schedule(static) reduction(|| : changed)
  for (std::size_t p = 0; p < contact.size(); ++p) {
    ContactPoint<D>& c = contact[p];
    const bool active = normal_velocity(c, cell_nodes, v) < c.target;
    changed = changed || active != c.active;
    c.active = active;
  }
  return changed;
}

template <int D>
void add_contact_forces(const std::vector<ContactPoint<D>>& contact, const CellNodes<D>& cell_nodes,
                        const std::vector<Vec<D>>& v, Eigen::VectorXd& R) {
  for (const ContactPoint<D>& c : contact) {
    if (!c.active) continue;
    const auto N = c.shape();
    const double force = c.stiffness * (c.target - normal_velocity(c, cell_nodes, v));
    for (int i = 0; i < power(3, D); ++i) R.segment<D>(cell_nodes[c.cell][i] * D) += force * N[i] * c.normal;
  }
}

template <int D>
void add_contact_stiffness(const std::vector<ContactPoint<D>>& contact, BlockSystem<D>& system) {
  using CellMatrix = typename BlockSystem<D>::CellMatrix;
  for (const ContactPoint<D>& c : contact) {
    if (!c.active) continue;
    const auto N = c.shape();
    Vec<power(3, D) * D> row;
    for (int i = 0; i < power(3, D); ++i) row.template segment<D>(i * D) = N[i] * c.normal;
    const CellMatrix K = c.stiffness * row * row.transpose();
    system.add_cell(c.cell, K);
  }
}

/// Contact energy [W]: quadratic in the violation.
template <int D>
double contact_energy(const std::vector<ContactPoint<D>>& contact, const CellNodes<D>& cell_nodes,
                      const std::vector<Vec<D>>& v) {
  double energy = 0.0;
  for (const ContactPoint<D>& c : contact) {
    const double violation = std::max(0.0, c.target - normal_velocity(c, cell_nodes, v));
    energy += 0.5 * c.stiffness * violation * violation;
  }
  return energy;
}

}  // namespace tremie
