#include "libmpm/linear/block_system.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace tremie {

struct SparseSystem {
  Eigen::SparseMatrix<double> matrix;  ///< its lower half, a column an unknown
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::AMDOrdering<int>> factor;
};

std::unique_ptr<SparseSystem, void (*)(SparseSystem*)> sparse_system() {
  return {new SparseSystem, [](SparseSystem* system) { delete system; }};
}

template <int D>
void BlockSystem<D>::set_pattern(const ActiveGrid<D>& grid) {
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

template <int D>
void BlockSystem<D>::set_zero() {
  double* value = sparse_->matrix.valuePtr();
  std::fill(value, value + sparse_->matrix.nonZeros(), 0.0);
}

template <int D>
void BlockSystem<D>::add_diagonal(int node, int d, double value) {
  sparse_->matrix.valuePtr()[diagonal_[node * D + d]] += value;
}

template <int D>
void BlockSystem<D>::add_cell(int cell, const CellMatrix& K) {
  const auto& nodes = cell_nodes_[cell];
  if (!mirrors_.empty()) return add_mirrored_cell(cell, K);
  for (int a = 0; a < n_local; ++a)
    for (int b = 0; b <= a; ++b) add_block(nodes[a], nodes[b], K.template block<D, D>(a * D, b * D), a == b);
}

template <int D>
void BlockSystem<D>::fix(const std::vector<char>& fixed) {
  const int* outer = sparse_->matrix.outerIndexPtr();
  const int* inner = sparse_->matrix.innerIndexPtr();
  double* value = sparse_->matrix.valuePtr();
  for (int j = 0; j < n_nodes_ * D; ++j)
    for (int k = outer[j]; k < outer[j + 1]; ++k)
      if (fixed[j] || fixed[inner[k]]) value[k] = inner[k] == j ? 1.0 : 0.0;
}

template <int D>
bool BlockSystem<D>::factorise() {
  if (banded_) return factorise_band();
  if (!analysed_) sparse_->factor.analyzePattern(sparse_->matrix);
  analysed_ = true;
  sparse_->factor.factorize(sparse_->matrix);
  return sparse_->factor.info() == Eigen::Success;
}

template <int D>
Eigen::VectorXd BlockSystem<D>::solve(const Eigen::VectorXd& rhs) const {
  if (!banded_) return sparse_->factor.solve(rhs);
  Eigen::VectorXd x(rhs.size());
  for (int i = 0; i < rhs.size(); ++i) x[band_dof_[i]] = rhs[i];
  band_.solve(x);
  Eigen::VectorXd solution(rhs.size());
  for (int i = 0; i < rhs.size(); ++i) solution[i] = x[band_dof_[i]];
  return solution;
}

template <int D>
void BlockSystem<D>::find_neighbours() {
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

template <int D>
void BlockSystem<D>::lay_out() {
  const int n = n_nodes_ * D;
  std::vector<int> outer(n + 1, 0);
  for (int i = 0; i < n_nodes_; ++i)
    for (int d = 0; d < D; ++d)
      outer[i * D + d + 1] = outer[i * D + d] + static_cast<int>(neighbours_[i].size()) * D - d;
  sparse_->matrix.resize(n, n);
  sparse_->matrix.resizeNonZeros(outer[n]);
  std::copy(outer.begin(), outer.end(), sparse_->matrix.outerIndexPtr());
  diagonal_.resize(n);
  for (int i = 0; i < n_nodes_; ++i)
    for (int d = 0; d < D; ++d) {
      int k = outer[i * D + d];
      diagonal_[i * D + d] = k;
      for (int j : neighbours_[i])
        for (int e = j == i ? d : 0; e < D; ++e) sparse_->matrix.innerIndexPtr()[k++] = j * D + e;
    }
}

template <int D>
void BlockSystem<D>::number_across_the_thin_way(const ActiveGrid<D>& grid) {
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

template <int D>
bool BlockSystem<D>::factorise_band() {
  band_.reset(n_nodes_ * D, bandwidth_);
  const int* outer = sparse_->matrix.outerIndexPtr();
  const int* inner = sparse_->matrix.innerIndexPtr();
  for (int j = 0; j < n_nodes_ * D; ++j)
    for (int k = outer[j]; k < outer[j + 1]; ++k) {
      const auto [low, high] = std::minmax(band_dof_[inner[k]], band_dof_[j]);
      band_.add(high, low, sparse_->matrix.valuePtr()[k]);
    }
  return band_.factorise();
}

template <int D>
void BlockSystem<D>::add_mirrored_cell(int cell, const CellMatrix& K) {
  const auto& nodes = cell_nodes_[cell];
  Vec<n_dof> sign = Vec<n_dof>::Ones();
  for (int a = 0; a < n_local; ++a) {
    if (unknown_[nodes[a]] == nodes[a]) continue;
    const auto m = std::lower_bound(mirrors_.begin(), mirrors_.end(), nodes[a],
                                    [](const MirrorNode<D>& mirror, int node) { return mirror.node < node; });
    sign.template segment<D>(a * D) = m->sign;
  }
  const CellMatrix mirrored = sign.asDiagonal() * K * sign.asDiagonal();
  for (int a = 0; a < n_local; ++a)
    for (int b = 0; b <= a; ++b)
      add_block(unknown_[nodes[a]], unknown_[nodes[b]], mirrored.template block<D, D>(a * D, b * D), a == b);
}

template <int D>
void BlockSystem<D>::add_block(int row, int column, const Mat<D, D>& block, bool same_local_node) {
  // On a periodic axis of one or two cells several local nodes are one active node: both halves of the cell
  // matrix then fall on one block and both count.
  if (row == column) {
    for (int d = 0; d < D; ++d)
      for (int e = d; e < D; ++e)
        sparse_->matrix.valuePtr()[diagonal_[column * D + d] + e - d] +=
            same_local_node ? block(e, d) : block(e, d) + block(d, e);
    return;
  }
  const bool below = row > column;
  const int i = below ? column : row, j = below ? row : column;
  const auto& list = neighbours_[i];
  const int slot = static_cast<int>(std::lower_bound(list.begin(), list.end(), j) - list.begin());
  for (int d = 0; d < D; ++d) {
    double* value = sparse_->matrix.valuePtr() + sparse_->matrix.outerIndexPtr()[i * D + d] + slot * D - d;
    for (int e = 0; e < D; ++e) value[e] += below ? block(e, d) : block(d, e);
  }
}

template class BlockSystem<2>;
#ifndef TREMIE_SECTIONS_ONLY  // the page for the browser has no vane and nothing in space
template class BlockSystem<1>;
template class BlockSystem<3>;
#endif

}  // namespace tremie
