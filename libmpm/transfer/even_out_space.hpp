#pragma once

// even_out.hpp's displacements in space. The mass is diagonal there, so that the preconditioner M + B' C B of
// pressure_preconditioner.hpp is the matrix itself, but for walls inside the grid and its single precision:
// one or two iterations.

#include "libmpm/step/space_system.hpp"
#include "libmpm/transfer/even_out.hpp"

namespace tremie {

inline std::vector<Vec<3>> even_out_in_space(const YieldProblem<ThreeD>& problem, const CellFill& cells,
                                             SpaceSystem& system) {
  const auto& grid = problem.grid;
  PressurePreconditioner& preconditioner = system.preconditioner;  // its room: the step's solve is done
  const PressureRows& rows = preconditioner.rows();
  std::vector<Quadrature<ThreeD>::DivergenceRows> b;  // as many as there are different ones
  std::vector<Vec<3>> u(grid.node_index.size(), Vec<3>::Zero());
  std::vector<char> fixed;
  Eigen::VectorXd R = fill_forces(problem, cells, fixed);
  double trace = 0.0;
  for (double m : problem.nodes.mass) trace = std::max(trace, 1e-12 * m);
  std::vector<Mat<3, 3>> G(u.size());
  for (int i = 0; i < grid.n_nodes(); ++i)
    G[i] = std::max(trace, problem.nodes.mass[i]) * Mat<3, 3>::Identity();
  std::vector<BoundPoint<3>> bound = problem.bound;
  for (BoundPoint<3>& wall : bound) wall.stiffness *= problem.dt;
  const auto multiply = [&](const Eigen::VectorXd& x, Eigen::VectorXd& out) {
    std::vector<double> pull(cells.stiffness.size());
#pragma omp parallel for schedule(static)
    for (int c = 0; c < grid.n_cells(); ++c) {
      double div = 0.0;
      for (int k = 0; k < 27; ++k) div += b[rows.place_of(c)][k].dot(x.segment<3>(3 * grid.cell_nodes[c][k]));
      pull[c] = cells.stiffness[c] * div;
    }
#pragma omp parallel for schedule(static)
    for (int i = 0; i < grid.n_nodes(); ++i) {
      Vec<3> sum = std::max(trace, problem.nodes.mass[i]) * x.segment<3>(3 * i);
      for (const int* e = system.batches.entries_begin(i); e != system.batches.entries_end(i); ++e)
        sum += pull[CellBatches::cell_of(*e)] *
               b[rows.place_of(CellBatches::cell_of(*e))][CellBatches::local_of(*e)];
      out.segment<3>(3 * i) = sum;
    }
    add_bound_products(bound, grid.cell_nodes, x, out);
    fold_mirrors<3>(grid, out);
    mask(fixed, out);
  };
  add_bound_blocks(bound, grid.cell_nodes, G);
  fold_mirrors(grid, G);
  invert_blocks(fixed, G);
  if (!preconditioner.build(grid, system.batches, problem.quadrature, G, cells.stiffness, fill_stiffness))
    return u;
  give_back(G);
  b.resize(rows.n_rows());
  for (int c = 0; c < grid.n_cells(); ++c) b[rows.place_of(c)] = problem.quadrature.divergence_rows(c);
  Eigen::VectorXf r4 = Eigen::VectorXf::Zero(4 * grid.n_nodes()), z4;
  const auto precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    for (int i = 0; i < grid.n_nodes(); ++i) r4.segment<3>(4 * i) = r.segment<3>(3 * i).cast<float>();
    preconditioner.apply(system.batches, grid, r4, z4);
    for (int i = 0; i < grid.n_nodes(); ++i) z.segment<3>(3 * i) = z4.segment<3>(4 * i).cast<double>();
  };
  Eigen::VectorXd x;
  conjugate_gradients(multiply, precondition, {.reduction = 1e-6, .most = 50}, R, x);
  for (int i = 0; i < grid.n_nodes(); ++i) u[i] = x.segment<3>(3 * i);
  return u;
}

}  // namespace tremie
