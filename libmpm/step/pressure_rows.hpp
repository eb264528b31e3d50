#pragma once

// The divergence rows B of the cells and the node blocks G^-1 that pressure_preconditioner.hpp is made of, in
// single precision: what pressures do to the nodes, what velocities do to the cells.

#include <algorithm>
#include <vector>

#include "libmpm/step/cell_batches.hpp"

namespace tremie {

class PressureRows {
 public:
  /// Columns of a node's inverse block.
  using Block = std::array<Eigen::Vector4f, 3>;
  static Eigen::Vector4f times(const Block& G, const Eigen::Vector4f& r) {
    return G[0] * r[0] + G[1] * r[1] + G[2] * r[2];
  }

  /// `b`: rows of each cell's mean divergence [1/m]; `G_inverse`: node blocks, zero where a wall prescribes;
  /// `stiffness`: C [J s], a cell with 0 is left out.
  void build(const ActiveGrid<3>& grid, const CellBatches& batches,
             const std::vector<std::array<Vec<3>, 27>>& b, const std::vector<Mat<3, 3>>& inverse_blocks,
             const std::vector<double>& stiffness);

  /// Divergence of the field y in cell c, four numbers a node.
  float divergence(const ActiveGrid<3>& grid, int c, const Eigen::VectorXf& y) const {
    const auto& nodes = grid.cell_nodes[c];
    Eigen::Vector4f even = Eigen::Vector4f::Zero(), odd = even;
    for (int k = 0; k < 26; k += 2) {
      even += row[27 * c + k].cwiseProduct(y.segment<4>(4 * nodes[k]));
      odd += row[27 * c + k + 1].cwiseProduct(y.segment<4>(4 * nodes[k + 1]));
    }
    even += row[27 * c + 26].cwiseProduct(y.segment<4>(4 * nodes[26]));
    return (even + odd).sum();
  }
  /// What the cells' pressures p push node i with.
  Eigen::Vector4f push(const CellBatches& batches, int i, const Eigen::VectorXf& p) const {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero(), other = sum;
    const int *e = batches.entries_begin(i), *end = batches.entries_end(i);
    const Eigen::Vector4f* of_node = &row_of_node[e - batches.entries_begin(0)];
    for (; e + 1 < end; e += 2, of_node += 2)
      sum += p[e[0] / 27] * of_node[0], other += p[e[1] / 27] * of_node[1];
    if (e != end) sum += p[*e / 27] * *of_node;
    return sum + other;
  }

  std::vector<Block> G_inverse;
  std::vector<Eigen::Vector4f> row;          ///< [27 cell + local node], zero in cells left out
  std::vector<Eigen::Vector4f> row_of_node;  ///< the same, node by node, its cells in their order
  Eigen::VectorXf softness;                  ///< C^-1; 1 in cells left out
  std::vector<char> left_out;

 private:
  void mirror(const ActiveGrid<3>& grid);
};

inline void PressureRows::build(const ActiveGrid<3>& grid, const CellBatches& batches,
                                const std::vector<std::array<Vec<3>, 27>>& b,
                                const std::vector<Mat<3, 3>>& inverse_blocks,
                                const std::vector<double>& stiffness) {
  G_inverse.resize(inverse_blocks.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < G_inverse.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d)
      G_inverse[i][d] << inverse_blocks[i].col(static_cast<Eigen::Index>(d)).cast<float>(), 0.0f;
  row.resize(27 * grid.cell_index.size());
  softness.resize(grid.n_cells());
  left_out.resize(grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    left_out[c] = stiffness[c] > 0.0 ? 0 : 1;
    softness[c] = left_out[c] ? 1.0f : static_cast<float>(1.0 / stiffness[c]);
    for (int k = 0; k < 27; ++k)
      row[27 * c + k] << (left_out[c] ? Vec<3>(Vec<3>::Zero()) : b[c][k]).cast<float>(), 0.0f;
  }
  mirror(grid);
  row_of_node.resize(row.size());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < grid.n_nodes(); ++i)
    for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
      row_of_node[e - batches.entries_begin(0)] = row[*e];
}

/// A cell's rows at nodes behind a plane of symmetry join those of the nodes before it, which it sees too.
inline void PressureRows::mirror(const ActiveGrid<3>& grid) {
  if (grid.mirrors.empty()) return;
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < 27; ++k) {
      int of = 0;
      Eigen::Vector4f sign = Eigen::Vector4f::Ones();
      for (int d = 0; d < 3; ++d) {
        const int first = grid.axes[d].first_control(grid.cell_index[c][d]);
        const int j = first + local_offset<3>(k)[d], image = grid.axes[d].mirrored(j);
        of = 3 * of + image - first;
        if (image != j) sign[d] = -1.0f;
      }
      if (of == k) continue;
      row[27 * c + of] += sign.cwiseProduct(row[27 * c + k]);
      row[27 * c + k].setZero();
    }
}

}  // namespace tremie
