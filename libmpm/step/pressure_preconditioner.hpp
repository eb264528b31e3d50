#pragma once

// A preconditioner that does not mind a stiff bulk modulus.
//
// With one divergence a cell the matrix of a step is A = D + B' C B: D inertia, viscosity and contact, B the
// mean divergences of the cells, C = V K dt their stiffness. P = G + B' C B keeps the stiff part whole and
// replaces D by its node blocks G alone, so that the spectrum of P^-1 A lies within that of G^-1 D whatever K
// is. By Woodbury's identity
//
//   P^-1 = G^-1 - G^-1 B' S^-1 B G^-1,     S = C^-1 + B G^-1 B',
//
// with one unknown a cell in S, the pressures, coupled over two cells each way: a narrow band.

#include <omp.h>

#include <algorithm>
#include <vector>

#include "libmpm/step/band_cholesky.hpp"
#include "libmpm/step/cell_batches.hpp"

namespace tremie {

class PressurePreconditioner {
 public:
  using Rows = std::vector<std::array<Vec<3>, 27>>;

  /// `b`: rows of each cell's mean divergence [1/m]; `G_inverse`: node blocks, zero where a wall prescribes;
  /// `stiffness`: C [J s], a cell with 0 is left out. False where S is not positive definite.
  bool build(const ActiveGrid<3>& grid, const CellBatches& batches, const Rows& b,
             std::vector<Mat<3, 3>> G_inverse, const std::vector<double>& stiffness);
  /// z = P^-1 r. `b` as in build().
  void apply(const CellBatches& batches, const ActiveGrid<3>& grid, const Rows& b, const Eigen::VectorXd& r,
             Eigen::VectorXd& z);

 private:
  void number_across_the_thin_way(const ActiveGrid<3>& grid);

  std::vector<Mat<3, 3>> G_inverse_;
  std::vector<int> number_;  ///< of each cell in the band
  std::vector<char> used_;
  int bandwidth_ = 0;
  BandCholesky<float> band_;
  BandCholesky<float>::Vector p_;
};

inline void PressurePreconditioner::number_across_the_thin_way(const ActiveGrid<3>& grid) {
  Index<3> way{0, 1, 2};
  std::stable_sort(way.begin(), way.end(),
                   [&](int a, int b) { return grid.cell_map.extent[a] > grid.cell_map.extent[b]; });
  std::vector<int> by_place(grid.n_cells());
  for (int c = 0; c < grid.n_cells(); ++c) by_place[c] = c;
  std::sort(by_place.begin(), by_place.end(), [&](int a, int b) {
    for (int d : way)
      if (grid.cell_index[a][d] != grid.cell_index[b][d])
        return grid.cell_index[a][d] < grid.cell_index[b][d];
    return false;
  });
  number_.resize(by_place.size());
  for (std::size_t k = 0; k < by_place.size(); ++k) number_[by_place[k]] = static_cast<int>(k);
}

inline bool PressurePreconditioner::build(const ActiveGrid<3>& grid, const CellBatches& batches,
                                          const Rows& b, std::vector<Mat<3, 3>> G_inverse,
                                          const std::vector<double>& stiffness) {
  G_inverse_ = std::move(G_inverse);
  number_across_the_thin_way(grid);
  const int n = grid.n_cells();
  used_.resize(n);
  for (int c = 0; c < n; ++c) used_[c] = stiffness[c] > 0.0;
  std::vector<int> reach(n, 0);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < n; ++c)
    for (int i : grid.cell_nodes[c])
      for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
        reach[c] = std::max(reach[c], number_[c] - number_[*e / 27]);
  bandwidth_ = *std::max_element(reach.begin(), reach.end());
  band_.reset(n, bandwidth_);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < n; ++c) {  // the rows of one cell belong to one thread
    band_.add(number_[c], number_[c], static_cast<float>(used_[c] ? 1.0 / stiffness[c] : 1.0));
    if (!used_[c]) continue;
    for (int k = 0; k < 27; ++k) {
      const int i = grid.cell_nodes[c][k];
      const Vec<3> w = G_inverse_[i] * b[c][k];
      for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e) {
        const int other = *e / 27;
        if (number_[other] <= number_[c] && used_[other])
          band_.add(number_[c], number_[other], static_cast<float>(w.dot(b[other][*e % 27])));
      }
    }
  }
  return band_.factorise();
}

inline void PressurePreconditioner::apply(const CellBatches& batches, const ActiveGrid<3>& grid,
                                          const Rows& b, const Eigen::VectorXd& r, Eigen::VectorXd& z) {
  const int n = grid.n_cells(), n_nodes = grid.n_nodes();
  z.resize(r.size());
  p_.resize(n);
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int i = 0; i < n_nodes; ++i) z.segment<3>(3 * i) = G_inverse_[i] * r.segment<3>(3 * i);
#pragma omp for schedule(static)
    for (int c = 0; c < n; ++c) {
      double sum = 0.0;
      if (used_[c])
        for (int k = 0; k < 27; ++k) sum += b[c][k].dot(z.segment<3>(3 * grid.cell_nodes[c][k]));
      p_[number_[c]] = static_cast<float>(sum);
    }
  }
  band_.solve(p_);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n_nodes; ++i) {
    Vec<3> push = Vec<3>::Zero();
    for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
      if (used_[*e / 27]) push += static_cast<double>(p_[number_[*e / 27]]) * b[*e / 27][*e % 27];
    z.segment<3>(3 * i) -= G_inverse_[i] * push;
  }
}

}  // namespace tremie
