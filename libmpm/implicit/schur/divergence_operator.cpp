#include "libmpm/implicit/schur/divergence_operator.hpp"

namespace tremie {

void DivergenceOperator::number_rows(const ActiveGrid<3>& grid, const Quadrature<ThreeD>& quadrature) {
  std::array<int, 64> of_kind;
  of_kind.fill(-1);
  int n = 0;
  resize_for_overwrite(rows_of_, grid.cell_index.size());
  for (std::size_t c = 0; c < rows_of_.size(); ++c) {
    if (!quadrature.full[c] || left_out[c]) {
      rows_of_[c] = n++;
      continue;
    }
    int& shared = of_kind[cell_ends(grid.axes, grid.cell_index[c])];
    if (shared < 0) shared = n++;
    rows_of_[c] = shared;
  }
  resize_for_overwrite(rows_, static_cast<std::size_t>(n));
}

void DivergenceOperator::build(const ActiveGrid<3>& grid, const Quadrature<ThreeD>& quadrature,
                               const std::vector<Mat<3, 3>>& inverse_blocks,
                               const std::vector<double>& stiffness) {
  resize_for_overwrite(G_inverse, inverse_blocks.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < G_inverse.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d) G_inverse[i][d] << inverse_blocks[i].col(d).cast<float>(), 0.0f;
  softness.resize(grid.n_cells());
  left_out.resize(grid.cell_index.size());
  for (int c = 0; c < grid.n_cells(); ++c) {
    left_out[c] = stiffness[c] > 0.0 ? 0 : 1;
    softness[c] = left_out[c] ? 1.0f : static_cast<float>(1.0 / stiffness[c]);
  }
  number_rows(grid, quadrature);
  resize_for_overwrite(cell_of_rows_, rows_.size());
  for (int c = 0; c < grid.n_cells(); ++c) cell_of_rows_[rows_of_[c]] = c;
#pragma omp parallel for schedule(static)
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const int c = cell_of_rows_[r];
    const auto& b = quadrature.divergence_rows(c);
    for (std::size_t k = 0; k < 27; ++k)
      rows_[r][k] << (left_out[c] ? Vec<3>(Vec<3>::Zero()) : b[k]).template cast<float>(), 0.0f;
    mirror(grid, c, rows_[r]);
  }
}

/// A cell's rows at nodes behind a plane of symmetry join those of the nodes before it, which it sees too.
void DivergenceOperator::mirror(const ActiveGrid<3>& grid, int c, CellRows& row) const {
  if (grid.mirrors.empty()) return;
  for (int k = 0; k < 27; ++k) {
    int of = 0;
    Eigen::Vector4f sign = Eigen::Vector4f::Ones();
    for (int d = 0; d < 3; ++d) {
      const int first = grid.axes[d].first_node(grid.cell_index[c][d]);
      const int j = first + local_offset<3>(k)[d], image = grid.axes[d].mirrored(j);
      of = 3 * of + image - first;
      if (image != j) sign[d] = -1.0f;
    }
    if (of == k) continue;
    row[of] += sign.cwiseProduct(row[k]);
    row[k].setZero();
  }
}

}  // namespace tremie
