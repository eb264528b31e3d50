#include "libmpm/implicit/shifting/particle_shifting_3d.hpp"

namespace tremie {

namespace detail {

/// The matrix M + B' C B in double precision.
struct EveningMatrix {
  const YieldProblem<ThreeD>& problem;
  const std::vector<double>& stiffness;  ///< C, of the cells
  const std::vector<char>& fixed;
  const CellBatches& batches;
  const DivergenceOperator& rows;
  std::vector<Quadrature<ThreeD>::DivergenceRows> b;  ///< as many as there are different ones
  std::vector<double> mass;                           ///< of the nodes
  std::vector<PointTerm<3>> bound;

  void make_rows() {
    b.resize(rows.n_rows());
#pragma omp parallel for schedule(static)
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = problem.quadrature.divergence_rows(rows.a_cell_of(r));
  }
  /// B' times one number a cell, at node i.
  Vec<3> push(int i, const std::vector<double>& pull, Vec<3> sum) const {
    for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
      sum += pull[CellBatches::cell_of(*e)] *
             b[rows.place_of(CellBatches::cell_of(*e))][CellBatches::local_of(*e)];
    return sum;
  }
  /// fill_forces() by all threads.
  Eigen::VectorXd forces(const std::vector<double>& misfill) const {
    const auto& grid = problem.grid;
    std::vector<double> pull(stiffness.size());
    for (std::size_t c = 0; c < pull.size(); ++c) pull[c] = stiffness[c] * misfill[c];
    Eigen::VectorXd R(3 * grid.n_nodes());
#pragma omp parallel for schedule(static)
    for (int i = 0; i < grid.n_nodes(); ++i) R.segment<3>(3 * i) = push(i, pull, Vec<3>::Zero());
    fold_mirrors<3>(grid, R);
    mask(fixed, R);
    return R;
  }
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& out) const {
    const auto& grid = problem.grid;
    std::vector<double> pull(stiffness.size());
#pragma omp parallel for schedule(static)
    for (int c = 0; c < grid.n_cells(); ++c) {
      double div = 0.0;
      for (int k = 0; k < 27; ++k) div += b[rows.place_of(c)][k].dot(x.segment<3>(3 * grid.cell_nodes[c][k]));
      pull[c] = stiffness[c] * div;
    }
#pragma omp parallel for schedule(static)
    for (int i = 0; i < grid.n_nodes(); ++i)
      out.segment<3>(3 * i) = push(i, pull, mass[i] * x.segment<3>(3 * i));
    add_penalty_products(bound, grid.cell_nodes, x, out);
    fold_mirrors<3>(grid, out);
    mask(fixed, out);
  }
};

}  // namespace detail

std::vector<Vec<3>> shifting_displacement_3d(const YieldProblem<ThreeD>& problem, const CellFill& cells,
                                             MatrixFreeSystem& system) {
  const auto& grid = problem.grid;
  SchurComplementPreconditioner& preconditioner =
      system.preconditioner;  // its memory: the step's solve is done
  const std::vector<char> fixed = held_nodes<3>(grid, cells);
  detail::EveningMatrix matrix{problem, cells.stiffness, fixed, system.batches, preconditioner.rows(), {},
                               {},      problem.bound};
  const double trace = trace_of_mass(problem.nodes.mass);
  resize_for_overwrite(matrix.mass, problem.nodes.mass.size());
  for (std::size_t i = 0; i < matrix.mass.size(); ++i)
    matrix.mass[i] = std::max(trace, problem.nodes.mass[i]);
  for (PointTerm<3>& wall : matrix.bound) wall.penalty *= problem.dt;

  std::vector<Mat<3, 3>> G(grid.node_index.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < grid.n_nodes(); ++i) G[i] = matrix.mass[i] * Mat<3, 3>::Identity();
  add_penalty_blocks(matrix.bound, grid.cell_nodes, G);
  fold_mirrors(grid, G);
  invert_blocks(fixed, G);
  std::vector<Vec<3>> displacement(grid.node_index.size(), Vec<3>::Zero());
  if (!preconditioner.build(grid, system.batches, problem.quadrature, G, cells.stiffness, fill_stiffness))
    return displacement;
  release(G);
  matrix.make_rows();

  Eigen::VectorXd R = matrix.forces(cells.misfill), x;
  Eigen::VectorXf r4(4 * grid.n_nodes()), z4;
  const auto precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
#pragma omp parallel for schedule(static)
    for (int i = 0; i < grid.n_nodes(); ++i) r4.segment<4>(4 * i) << r.segment<3>(3 * i).cast<float>(), 0.0f;
    preconditioner.apply(system.batches, grid, r4, system.forces, z4);
#pragma omp parallel for schedule(static)
    for (int i = 0; i < grid.n_nodes(); ++i) z.segment<3>(3 * i) = z4.segment<3>(4 * i).cast<double>();
  };
  conjugate_gradients([&](const Eigen::VectorXd& p, Eigen::VectorXd& Ap) { matrix.multiply(p, Ap); },
                      precondition, {.reduction = 1e-6, .most = 50}, R, x);
  for (int i = 0; i < grid.n_nodes(); ++i) displacement[i] = x.segment<3>(3 * i);
  return displacement;
}

}  // namespace tremie
