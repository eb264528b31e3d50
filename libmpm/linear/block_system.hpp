#pragma once

// The symmetric positive definite system of an implicit step on the active nodes: D x D blocks, assembled
// from cells, factorised by a Cholesky method: on a band where the body is thin one way, sparse otherwise.
// What follows from the set of active cells alone is kept while that is.

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/linear/band_cholesky.hpp"

namespace tremie {

template <int D>
class BlockSystem {
 public:
  static constexpr int n_local = power(3, D), n_dof = n_local * D;
  using CellMatrix = Eigen::Matrix<double, n_dof, n_dof>;

  /// Lays out the matrix for this grid; cheap when the grid is the one of the last call.
  void set_pattern(const ActiveGrid<D>& grid) {
    if (grid.cell_nodes == cell_nodes_ && grid.n_nodes() == n_nodes_ && grid.mirrors == mirrors_) return;
    cell_nodes_ = grid.cell_nodes;
    mirrors_ = grid.mirrors;
    n_nodes_ = grid.n_nodes();
    unknown_.resize(n_nodes_);
    for (int i = 0; i < n_nodes_; ++i) unknown_[i] = i;
    for (const MirrorNode<D>& m : mirrors_) unknown_[m.node] = m.of;
    find_neighbours();
    lay_out();
    number_across_the_thin_way(grid);
    analysed_ = false;
  }
  void set_zero() { std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0); }

  /// Adds a cell's matrix; rows and columns ordered local node by local node. Only its lower half is read.
  void add_cell(int cell, const CellMatrix& K) {
    const auto& nodes = cell_nodes_[cell];
    if (!mirrors_.empty()) return add_mirrored_cell(cell, K);
    for (int a = 0; a < n_local; ++a)
      for (int b = 0; b <= a; ++b)
        add_block(nodes[a], nodes[b], K.template block<D, D>(a * D, b * D), a == b);
  }
  void add_diagonal(int node, int d, double value) { matrix_.valuePtr()[diagonal_[node * D + d]] += value; }

  void add_node_block(int node, const Mat<D, D>& block) { add_block(node, node, block, true); }

  /// Fixes a component: its row and column become those of the identity. Call after assembly.
  void fix(const std::vector<char>& fixed) {
    const int* outer = matrix_.outerIndexPtr();
    const int* inner = matrix_.innerIndexPtr();
    double* value = matrix_.valuePtr();
    for (int j = 0; j < n_nodes_ * D; ++j)
      for (int k = outer[j]; k < outer[j + 1]; ++k)
        if (fixed[j] || fixed[inner[k]]) value[k] = inner[k] == j ? 1.0 : 0.0;
  }
  /// Numerical factorisation; false where the matrix is not positive definite.
  bool factorise() {
    if (banded_) return factorise_band();
    if (!analysed_) solver_->analyzePattern(matrix_);
    analysed_ = true;
    solver_->factorize(matrix_);
    return solver_->info() == Eigen::Success;
  }
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const {
    if (!banded_) return solver_->solve(rhs);
    Eigen::VectorXd x(rhs.size());
    for (int i = 0; i < rhs.size(); ++i) x[band_dof_[i]] = rhs[i];
    band_.solve(x);
    Eigen::VectorXd solution(rhs.size());
    for (int i = 0; i < rhs.size(); ++i) solution[i] = x[band_dof_[i]];
    return solution;
  }
  double diagonal(int dof) const { return matrix_.valuePtr()[diagonal_[dof]]; }

 private:
  /// Sorted numbers of the nodes that share a cell with each node and are not before it.
  void find_neighbours() {
    neighbours_.assign(n_nodes_, {});
    for (int i = 0; i < n_nodes_; ++i) neighbours_[i].push_back(i);
    for (const auto& nodes : cell_nodes_)
      for (int a : nodes)
        for (int b : nodes)
          if (unknown_[b] >= unknown_[a]) neighbours_[unknown_[a]].push_back(unknown_[b]);
    for (auto& list : neighbours_) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  }
  void lay_out() {
    const int n = n_nodes_ * D;
    std::vector<int> outer(n + 1, 0);
    for (int i = 0; i < n_nodes_; ++i)
      for (int d = 0; d < D; ++d)
        outer[i * D + d + 1] = outer[i * D + d] + static_cast<int>(neighbours_[i].size()) * D - d;
    matrix_.resize(n, n);
    matrix_.resizeNonZeros(outer[n]);
    std::copy(outer.begin(), outer.end(), matrix_.outerIndexPtr());
    diagonal_.resize(n);
    for (int i = 0; i < n_nodes_; ++i)
      for (int d = 0; d < D; ++d) {
        int k = outer[i * D + d];
        diagonal_[i * D + d] = k;
        for (int j : neighbours_[i])
          for (int e = j == i ? d : 0; e < D; ++e) matrix_.innerIndexPtr()[k++] = j * D + e;
      }
  }
  /// Numbers the unknowns with the grid's shortest way running fastest and decides between band and sparse:
  /// in a plane the band's n b^2 operations win, by measurement, up to about 800 n^1.5; in 3D
  /// sparse wins where the body is small, and beyond that the band's dense kernels, with all threads, up to 800 MB.
  void number_across_the_thin_way(const ActiveGrid<D>& grid) {
    Index<D> way;
    for (int d = 0; d < D; ++d) way[d] = d;
    // A periodic axis is folded, so that what meets at its seam has near numbers: it counts half as long.
    const auto length = [&](int d) { return grid.node_map.extent[d] * (grid.axes[d].periodic ? 1 : 2); };
    std::sort(way.begin(), way.end(), [&](int a, int b) { return length(a) > length(b); });
    const auto place = [&](int node, int d) {
      const int i = grid.node_index[node][d], n = grid.node_map.extent[d];
      return !grid.axes[d].periodic ? i : 2 * i < n ? 2 * i : 2 * (n - 1 - i) + 1;
    };
    std::vector<int> by_place(n_nodes_);
    for (int i = 0; i < n_nodes_; ++i) by_place[i] = i;
    std::sort(by_place.begin(), by_place.end(), [&](int a, int b) {
      for (int d : way)
        if (grid.node_index[a][d] != grid.node_index[b][d]) return place(a, d) < place(b, d);
      return false;
    });
    band_dof_.resize(n_nodes_ * D);
    for (int k = 0; k < n_nodes_; ++k)
      for (int d = 0; d < D; ++d) band_dof_[by_place[k] * D + d] = k * D + d;
    bandwidth_ = 0;
    for (int i = 0; i < n_nodes_; ++i)
      for (int j : neighbours_[i])
        bandwidth_ = std::max(bandwidth_, std::abs(band_dof_[i * D] - band_dof_[j * D]) + D - 1);
    const double n = n_nodes_ * D, b = bandwidth_;
    banded_ = D < 3 ? b * b < 800.0 * std::sqrt(n) : n > 4000.0 && b * b < 200.0 * n && n * b < 1e8;
  }
  bool factorise_band() {
    band_.reset(n_nodes_ * D, bandwidth_);
    const int* outer = matrix_.outerIndexPtr();
    const int* inner = matrix_.innerIndexPtr();
    for (int j = 0; j < n_nodes_ * D; ++j)
      for (int k = outer[j]; k < outer[j + 1]; ++k) {
        const auto [low, high] = std::minmax(band_dof_[inner[k]], band_dof_[j]);
        band_.add(high, low, matrix_.valuePtr()[k]);
      }
    return band_.factorise();
  }
  /// What acts on a node behind a plane of symmetry acts, mirrored, on the one before it.
  void add_mirrored_cell(int cell, const CellMatrix& K) {
    const auto& nodes = cell_nodes_[cell];
    Vec<n_dof> sign = Vec<n_dof>::Ones();
    for (int a = 0; a < n_local; ++a) {
      if (unknown_[nodes[a]] == nodes[a]) continue;
      const auto m = std::lower_bound(mirrors_.begin(), mirrors_.end(), nodes[a],
                                      [](const MirrorNode<D>& one, int node) { return one.node < node; });
      sign.template segment<D>(a * D) = m->sign;
    }
    const CellMatrix mirrored = sign.asDiagonal() * K * sign.asDiagonal();
    for (int a = 0; a < n_local; ++a)
      for (int b = 0; b <= a; ++b)
        add_block(unknown_[nodes[a]], unknown_[nodes[b]], mirrored.template block<D, D>(a * D, b * D),
                  a == b);
  }
  void add_block(int row, int column, const Mat<D, D>& block, bool same_local_node) {
    // On a periodic axis of one or two cells several local nodes are one active node: both halves of the cell
    // matrix then fall on one block and both count.
    if (row == column) {
      for (int d = 0; d < D; ++d)
        for (int e = d; e < D; ++e)
          matrix_.valuePtr()[diagonal_[column * D + d] + e - d] +=
              same_local_node ? block(e, d) : block(e, d) + block(d, e);
      return;
    }
    const bool below = row > column;
    const int i = below ? column : row, j = below ? row : column;
    const auto& list = neighbours_[i];
    const int slot = static_cast<int>(std::lower_bound(list.begin(), list.end(), j) - list.begin());
    for (int d = 0; d < D; ++d) {
      double* value = matrix_.valuePtr() + matrix_.outerIndexPtr()[i * D + d] + slot * D - d;
      for (int e = 0; e < D; ++e) value[e] += below ? block(e, d) : block(d, e);
    }
  }

  std::vector<std::array<int, n_local>> cell_nodes_;
  std::vector<MirrorNode<D>> mirrors_;
  std::vector<int> unknown_;  ///< of each node: itself, or the one that it mirrors
  std::vector<std::vector<int>> neighbours_;
  std::vector<int> diagonal_;
  int n_nodes_ = -1;
  bool analysed_ = false, banded_ = false;
  std::vector<int> band_dof_;  ///< of each unknown
  int bandwidth_ = 0;
  BandCholesky<double> band_;
  Eigen::SparseMatrix<double> matrix_;
  using Solver = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::AMDOrdering<int>>;
  std::unique_ptr<Solver> solver_ = std::make_unique<Solver>();
};

}  // namespace tremie
