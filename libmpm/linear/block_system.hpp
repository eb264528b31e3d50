#pragma once

// The symmetric positive definite system of an implicit step on the active nodes: D x D blocks, assembled
// from cells, factorised by a Cholesky method: on a band where the body is thin one way, sparse otherwise.
// What follows from the set of active cells alone is kept while that is.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/linear/band_cholesky.hpp"

namespace tremie {

/// The matrix and Eigen's factor of it, whose headers take long to read.
struct SparseSystem;
std::unique_ptr<SparseSystem, void (*)(SparseSystem*)> sparse_system();

template <int D>
class BlockSystem {
 public:
  static constexpr int n_local = power(3, D), n_dof = n_local * D;
  using CellMatrix = Eigen::Matrix<double, n_dof, n_dof>;

  /// Lays out the matrix for this grid; cheap when the grid is the one of the last call.
  void set_pattern(const ActiveGrid<D>& grid);
  void set_zero();

  /// Adds a cell's matrix; rows and columns ordered local node by local node. Only its lower half is read.
  void add_cell(int cell, const CellMatrix& K);
  void add_diagonal(int node, int d, double value);
  void add_node_block(int node, const Mat<D, D>& block) { add_block(node, node, block, true); }

  /// Fixes a component: its row and column become those of the identity. Call after assembly.
  void fix(const std::vector<char>& fixed);
  /// Numerical factorisation; false where the matrix is not positive definite.
  bool factorise();
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const;

 private:
  /// Sorted numbers of the nodes that share a cell with each node and are not before it.
  void find_neighbours();
  void lay_out();
  /// Numbers the unknowns with the grid's shortest way running fastest and decides between band and sparse:
  /// in a plane the band's n b^2 operations win, by measurement, up to about 800 n^1.5; in 3D
  /// sparse wins where the body is small, and beyond that the band's dense kernels, with all threads, up to 800 MB.
  void number_across_the_thin_way(const ActiveGrid<D>& grid);
  bool factorise_band();
  /// What acts on a node behind a plane of symmetry acts, mirrored, on the one before it.
  void add_mirrored_cell(int cell, const CellMatrix& K);
  void add_block(int row, int column, const Mat<D, D>& block, bool same_local_node);

  CellNodes<D> cell_nodes_;
  std::vector<MirrorNode<D>> mirrors_;
  std::vector<int> unknown_;  ///< of each node: itself, or the one that it mirrors
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> diagonal_;
  int n_nodes_ = -1;
  bool analysed_ = false, banded_ = false;
  std::vector<int> band_dof_;  ///< of each unknown
  int bandwidth_ = 0;
  BandCholesky band_;
  std::unique_ptr<SparseSystem, void (*)(SparseSystem*)> sparse_ = sparse_system();
};

}  // namespace tremie
