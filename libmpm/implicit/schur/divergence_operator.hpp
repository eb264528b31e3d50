#pragma once

// The divergence rows B of the cells and the node blocks G^-1 that preconditioner.hpp is made of, in
// single precision: what pressures do to the nodes, what velocities do to the cells.

#include <algorithm>
#include <vector>

#include "libmpm/implicit/matrix_free/cell_gradients.hpp"
#include "libmpm/implicit/problem/quadrature.hpp"

namespace tremie {

class DivergenceOperator {
 public:
  /// Columns of a node's inverse block.
  using Block = std::array<Eigen::Vector4f, 3>;
  static Eigen::Vector4f times(const Block& G, const Eigen::Vector4f& r) {
    return G[0] * r[0] + G[1] * r[1] + G[2] * r[2];
  }

  /// `inverse_blocks`: of the nodes, zero where a wall prescribes; `stiffness`: C [J s], a cell with 0 is
  /// left out.
  void build(const ActiveGrid<3>& grid, const Quadrature<ThreeD>& quadrature,
             const std::vector<Mat<3, 3>>& inverse_blocks, const std::vector<double>& stiffness);

  /// Divergence of the field y in cell c, four numbers a node.
  float divergence(const ActiveGrid<3>& grid, int c, const Eigen::VectorXf& y) const {
    const auto& nodes = grid.cell_nodes[c];
    const Eigen::Vector4f* row = of_cell(c).data();
    Eigen::Vector4f even = Eigen::Vector4f::Zero(), odd = even;  // nodes, in sums that do not wait
    const auto add = [&](Eigen::Vector4f& sum, int k, const float* at) {
      sum += row[k].cwiseProduct(Eigen::Map<const Eigen::Vector4f>(at));
    };
    const auto node = [&](int k) { return y.data() + 4 * static_cast<std::ptrdiff_t>(nodes[k]); };
    if (grid.axes[2].periodic) {
      for (int k = 0; k < 27; ++k) add(k % 2 == 0 ? even : odd, k, node(k));
      return (even + odd).sum();
    }
    for (int k = 0;; k += 6) {  // three nodes in a row have numbers in a row
      const float* at = node(k);
      add(even, k, at), add(odd, k + 1, at + 4), add(even, k + 2, at + 8);
      if (k == 24) break;
      at = node(k + 3);
      add(odd, k + 3, at), add(even, k + 4, at + 4), add(odd, k + 5, at + 8);
    }
    return (even + odd).sum();
  }
  /// Adds what the pressures p(c) of the cells [first, last) push their nodes with; `to`: the nodes, four
  /// numbers each.
  template <class Pressure>
  void push(const ActiveGrid<3>& grid, int first, int last, Pressure p, float* to) const {
    // Going up a column of cells: what the middle and the top nodes have been given so far.
    Eigen::Vector4f middle[9], top[9];
    for (int c = first; c < last; ++c) {
      const auto& nodes = grid.cell_nodes[c];
      const Eigen::Vector4f* row = of_cell(c).data();
      const float pressure = p(c);
      const auto at = [&](int k) { return Eigen::Map<Eigen::Vector4f>(to + 4 * std::ptrdiff_t{nodes[k]}); };
      if (c == first || !follows(grid, c))
        for (int j = 0; j < 9; ++j) middle[j].setZero(), top[j].setZero();
#pragma GCC unroll 9
      for (int j = 0; j < 9; ++j) {
        at(3 * j) += middle[j] + pressure * row[3 * j];
        middle[j] = top[j] + pressure * row[3 * j + 1];
        top[j] = pressure * row[3 * j + 2];
      }
      if (c + 1 == last || !follows(grid, c + 1))
        for (int j = 0; j < 9; ++j) at(3 * j + 1) += middle[j], at(3 * j + 2) += top[j];
    }
  }
  /// The rows of a cell, one a local node; zero in cells left out.
  using CellRows = std::array<Eigen::Vector4f, 27>;
  const CellRows& of_cell(int c) const { return rows_[place_of(c)]; }
  /// Full cells of a kind have the same rows: how many different ones there are, and which are a cell's.
  std::size_t n_rows() const { return rows_.size(); }
  int place_of(int c) const { return rows_of_[c]; }
  /// A cell that has rows r.
  int a_cell_of(std::size_t r) const { return cell_of_rows_[r]; }
  const Eigen::Vector4f& of_entry(int e) const {
    return of_cell(CellBatches::cell_of(e))[CellBatches::local_of(e)];
  }

  std::vector<Block> G_inverse;
  Eigen::VectorXf softness;  ///< C^-1; 1 in cells left out
  std::vector<char> left_out;

 private:
  /// Whether cell c is the next of a column of cells: its first two nodes of a line are the last two of
  /// the cell before.
  static bool follows(const ActiveGrid<3>& grid, int c) {
    const auto &nodes = grid.cell_nodes[c], &before = grid.cell_nodes[c - 1];
    return nodes[0] == before[1] && nodes[1] == before[2];
  }
  void number_rows(const ActiveGrid<3>& grid, const Quadrature<ThreeD>& quadrature);
  void mirror(const ActiveGrid<3>& grid, int c, CellRows& row) const;

  std::vector<CellRows> rows_;     ///< those of full cells once a kind, of the others a cell each
  std::vector<int> rows_of_;       ///< of each cell: its place there
  std::vector<int> cell_of_rows_;  ///< the last cell that has each of them
};

}  // namespace tremie
