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
// with one unknown a cell in S, the pressures, coupled over two cells each way. For bodies of some thousand
// cells S is factorised as a band. The band's n b^2 operations grow like n^(7/3); beyond, S is solved by
// conjugate gradients of its own, to a twentieth: C^-1 bounds its condition, so that their number does not
// grow with the body.

#include <omp.h>

#include <algorithm>
#include <vector>

#include "libmpm/step/band_cholesky.hpp"
#include "libmpm/step/cell_batches.hpp"
#include "libmpm/step/conjugate_gradients.hpp"

namespace tremie {

class PressurePreconditioner {
 public:
  using Rows = std::vector<std::array<Vec<3>, 27>>;

  /// `b`: rows of each cell's mean divergence [1/m]; `G_inverse`: node blocks, zero where a wall prescribes;
  /// `stiffness`: C [J s], a cell with 0 is left out. False where S is not positive definite.
  bool build(const ActiveGrid<3>& grid, const CellBatches& batches, const Rows& b,
             std::vector<Mat<3, 3>> G_inverse, const std::vector<double>& stiffness);
  /// z = P^-1 r, its pressures in single precision.
  void apply(const CellBatches& batches, const ActiveGrid<3>& grid, const Eigen::VectorXd& r,
             Eigen::VectorXd& z);

 private:
  void number_across_the_thin_way(const ActiveGrid<3>& grid);
  void find_bandwidth(const ActiveGrid<3>& grid, const CellBatches& batches);
  void fill_rows(const ActiveGrid<3>& grid, const CellBatches& batches, const Rows& b,
                 const std::vector<double>& stiffness);
  void solve_by_rows();

  static constexpr double most_band_operations = 2e9;
  /// A row of S: its cells within two each way; an empty place is the cell itself with 0.
  struct Row {
    std::array<int, 125> cell;
    std::array<float, 125> value;
  };
  std::vector<Row> s_;
  Eigen::VectorXf diagonal_;
  bool by_band_ = true;

  std::vector<Mat<3, 3>> G_inverse_;
  std::vector<int> number_;                            ///< of each cell in the band
  std::vector<std::array<Eigen::Vector4f, 27>> rows_;  ///< of the divergences, zero in cells left out
  std::vector<Eigen::Vector4f> y_;
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

inline void PressurePreconditioner::find_bandwidth(const ActiveGrid<3>& grid, const CellBatches& batches) {
  std::vector<int> reach(grid.cell_index.size(), 0);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int i : grid.cell_nodes[c])
      for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
        reach[c] = std::max(reach[c], number_[c] - number_[*e / 27]);
  bandwidth_ = *std::max_element(reach.begin(), reach.end());
  const double n = grid.n_cells(), width = bandwidth_;
  // Rows know their neighbours by place, which a periodic axis repeats.
  const bool periodic = grid.axes[0].periodic || grid.axes[1].periodic || grid.axes[2].periodic;
  by_band_ = periodic || n * width * width < most_band_operations;
}

/// Row c holds every cell that shares a node with c; each belongs to one thread.
inline void PressurePreconditioner::fill_rows(const ActiveGrid<3>& grid, const CellBatches& batches,
                                              const Rows& b, const std::vector<double>& stiffness) {
  s_.resize(by_band_ ? 0 : grid.cell_index.size());
  diagonal_.resize(grid.n_cells());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const float own = stiffness[c] > 0.0 ? static_cast<float>(1.0 / stiffness[c]) : 1.0f;
    const auto add = [&](int other, float value) {
      if (by_band_) {
        if (number_[other] <= number_[c]) band_.add(number_[c], number_[other], value);
        return;
      }
      int place = 0;
      for (int d = 0; d < 3; ++d) place = 5 * place + grid.cell_index[other][d] - grid.cell_index[c][d] + 2;
      s_[c].cell[place] = other;
      s_[c].value[place] += value;
    };
    if (!by_band_) s_[c].cell.fill(c), s_[c].value.fill(0.0f);
    add(c, own);
    for (int k = 0; k < 27 && stiffness[c] > 0.0; ++k) {
      const int i = grid.cell_nodes[c][k];
      Eigen::Vector4f w = Eigen::Vector4f::Zero();
      w.head<3>() = (G_inverse_[i] * b[c][k]).cast<float>();
      for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
        add(*e / 27, w.dot(rows_[*e / 27][*e % 27]));
    }
    if (!by_band_) diagonal_[c] = s_[c].value[62];
  }
}

inline bool PressurePreconditioner::build(const ActiveGrid<3>& grid, const CellBatches& batches,
                                          const Rows& b, std::vector<Mat<3, 3>> G_inverse,
                                          const std::vector<double>& stiffness) {
  G_inverse_ = std::move(G_inverse);
  number_across_the_thin_way(grid);
  find_bandwidth(grid, batches);
  rows_.resize(grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < 27; ++k)
      rows_[c][k] << (stiffness[c] > 0.0 ? b[c][k] : Vec<3>(Vec<3>::Zero())).cast<float>(), 0.0f;
  if (by_band_)
    band_.reset(grid.n_cells(), bandwidth_);
  else
    for (int c = 0; c < grid.n_cells(); ++c) number_[c] = c;
  fill_rows(grid, batches, b, stiffness);
  return !by_band_ || band_.factorise();
}

/// p <- S^-1 p to a twentieth, by conjugate gradients on the diagonally scaled S.
inline void PressurePreconditioner::solve_by_rows() {
  const Eigen::Index n = p_.size();
  Eigen::VectorXd r = p_.cast<double>(), z = r.cwiseQuotient(diagonal_.cast<double>()), d = z, Sd(n);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  double rz = block_dot(r, z);
  const double enough = rz / 400.0;
  for (int i = 0; i < 100 && rz > enough; ++i) {
#pragma omp parallel for schedule(static)
    for (Eigen::Index c = 0; c < n; ++c) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 125; ++k)
        sum += static_cast<double>(s_[static_cast<std::size_t>(c)].value[k]) *
               d[s_[static_cast<std::size_t>(c)].cell[k]];
      Sd[c] = sum;
    }
    const double alpha = rz / block_dot(d, Sd);
    x += alpha * d;
    r -= alpha * Sd;
    z = r.cwiseQuotient(diagonal_.cast<double>());
    const double next = block_dot(r, z);
    d = z + next / rz * d;
    rz = next;
  }
  p_ = x.cast<float>();
}

inline void PressurePreconditioner::apply(const CellBatches& batches, const ActiveGrid<3>& grid,
                                          const Eigen::VectorXd& r, Eigen::VectorXd& z) {
  const int n = grid.n_cells(), n_nodes = grid.n_nodes();
  z.resize(r.size());
  y_.resize(n_nodes);
  p_.resize(n);
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int i = 0; i < n_nodes; ++i) {
      const Vec<3> y = G_inverse_[i] * r.segment<3>(3 * i);
      z.segment<3>(3 * i) = y;
      y_[i] << y.cast<float>(), 0.0f;
    }
#pragma omp for schedule(static)
    for (int c = 0; c < n; ++c) {
      Eigen::Vector4f even = Eigen::Vector4f::Zero(), odd = even;
      for (int k = 0; k < 26; k += 2) {
        even += rows_[c][k].cwiseProduct(y_[grid.cell_nodes[c][k]]);
        odd += rows_[c][k + 1].cwiseProduct(y_[grid.cell_nodes[c][k + 1]]);
      }
      even += rows_[c][26].cwiseProduct(y_[grid.cell_nodes[c][26]]);
      p_[number_[c]] = (even + odd).sum();
    }
  }
  if (by_band_)
    band_.solve(p_);
  else
    solve_by_rows();
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n_nodes; ++i) {
    Eigen::Vector4f push = Eigen::Vector4f::Zero();
    for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
      push += p_[number_[*e / 27]] * rows_[*e / 27][*e % 27];
    z.segment<3>(3 * i) -= G_inverse_[i] * push.head<3>().cast<double>();
  }
}

}  // namespace tremie
