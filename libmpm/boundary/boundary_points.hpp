#pragma once

// Walls inside the grid, sampled by boundary points: vane blades, a container, a gate.
//
// Setting the velocities of grid nodes near such a wall moves it by up to a cell. Here each point of the wall
// ties the velocity field where it lies to the wall's own, by a penalty of `stiffness` times the mass around
// it over dt: all of it where the concrete sticks, its normal part alone where it slips.

#include <vector>

#include "libmpm/boundary/contact.hpp"
#include "libmpm/transfer/apic.hpp"

namespace tremie {

/// A point of a wall.
template <int D>
struct BoundaryPoint {
  Vec<D> x;                          ///< [m]
  Vec<D> velocity = Vec<D>::Zero();  ///< of the wall [m/s]
  Vec<D> normal = Vec<D>::Zero();    ///< of a wall that the concrete slips along; zero where it sticks
};

/// A boundary point that touches concrete in this step.
template <int D>
struct PenaltyPoint {
  int cell = 0, source = 0;           ///< active cell; index of the boundary point
  std::array<double, power(3, D)> N;  ///< shape values in that cell
  Vec<D> velocity;                    ///< of the wall [m/s]
  Mat<D, D> stiffness;                ///< [kg/s]
};

/// The boundary points that lie in active cells.
template <int D>
std::vector<PenaltyPoint<D>> find_penalty_points(const ActiveGrid<D>& grid, const NodalState<D>& nodes,
                                                 const std::vector<BoundaryPoint<D>>& wall, double dt,
                                                 double stiffness) {
  std::vector<PenaltyPoint<D>> bound;
  for (std::size_t k = 0; k < wall.size(); ++k) {
    const Index<D> cell = detail::cell_of<D>(grid.axes, wall[k].x);
    PenaltyPoint<D> point;
    point.cell = grid.cell_map.at(cell);
    if (point.cell < 0) continue;
    point.source = static_cast<int>(k);
    point.N = stencil<D>(grid.axes, cell, local_coordinates<D>(grid.axes, cell, wall[k].x)).N;
    point.velocity = wall[k].velocity;
    double mass = 0.0;
    for (int i = 0; i < power(3, D); ++i) mass += point.N[i] * nodes.mass[grid.cell_nodes[point.cell][i]];
    const bool sticks = wall[k].normal.isZero();
    point.stiffness =
        stiffness * mass / dt *
        (sticks ? Mat<D, D>(Mat<D, D>::Identity()) : Mat<D, D>(wall[k].normal * wall[k].normal.transpose()));
    bound.push_back(point);
  }
  return bound;
}

/// Force of the wall on the concrete at a bound point [N].
template <int D>
Vec<D> wall_force(const PenaltyPoint<D>& b, const std::vector<std::array<int, power(3, D)>>& cell_nodes,
                  const std::vector<Vec<D>>& v) {
  Vec<D> u = Vec<D>::Zero();
  for (int i = 0; i < power(3, D); ++i) u += b.N[i] * v[cell_nodes[b.cell][i]];
  return b.stiffness * (b.velocity - u);
}

template <int D>
void add_penalty_forces(const std::vector<PenaltyPoint<D>>& bound,
                        const std::vector<std::array<int, power(3, D)>>& cell_nodes,
                        const std::vector<Vec<D>>& v, Eigen::VectorXd& R) {
  for (const PenaltyPoint<D>& b : bound) {
    const Vec<D> force = wall_force<D>(b, cell_nodes, v);
    for (int i = 0; i < power(3, D); ++i) R.segment<D>(cell_nodes[b.cell][i] * D) += b.N[i] * force;
  }
}

template <int D>
void add_penalty_stiffness(const std::vector<PenaltyPoint<D>>& bound, BlockSystem<D>& system) {
  for (const PenaltyPoint<D>& b : bound) {
    typename BlockSystem<D>::CellMatrix K;
    for (int i = 0; i < power(3, D); ++i)
      for (int j = 0; j < power(3, D); ++j)
        K.template block<D, D>(i * D, j * D) = b.N[i] * b.N[j] * b.stiffness;
    system.add_cell(b.cell, K);
  }
}

template <int D>
double penalty_energy(const std::vector<PenaltyPoint<D>>& bound,
                      const std::vector<std::array<int, power(3, D)>>& cell_nodes,
                      const std::vector<Vec<D>>& v) {
  double energy = 0.0;
  for (const PenaltyPoint<D>& b : bound) {
    Vec<D> u = b.velocity;
    for (int i = 0; i < power(3, D); ++i) u -= b.N[i] * v[cell_nodes[b.cell][i]];
    energy += 0.5 * u.dot(b.stiffness * u);
  }
  return energy;
}

}  // namespace tremie
