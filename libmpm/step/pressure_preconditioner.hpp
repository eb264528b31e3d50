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
// conjugate gradients of its own, to a hundredth: C^-1 bounds its condition, so that their number does not
// grow with the body.

#include <omp.h>

#include <algorithm>
#include <vector>

#include "libmpm/step/cell_batches.hpp"
#include "libmpm/step/conjugate_gradients.hpp"
#include "libmpm/step/two_ended_cholesky.hpp"

namespace tremie {

class PressurePreconditioner {
 public:
  using Rows = std::vector<std::array<Vec<3>, 27>>;

  /// `b`: rows of each cell's mean divergence [1/m]; `G_inverse`: node blocks, zero where a wall prescribes;
  /// `stiffness`: C [J s], a cell with 0 is left out. False where S is not positive definite.
  bool build(const ActiveGrid<3>& grid, const CellBatches& batches, const Rows& b,
             const std::vector<Mat<3, 3>>& G_inverse, const std::vector<double>& stiffness);
  /// z = P^-1 r, four numbers a node.
  void apply(const CellBatches& batches, const ActiveGrid<3>& grid, const Eigen::VectorXf& r,
             Eigen::VectorXf& z);

 private:
  void mirror_rows(const ActiveGrid<3>& grid);
  void number_across_the_thin_way(const ActiveGrid<3>& grid);
  template <class Use>
  void for_each_neighbour(const ActiveGrid<3>& grid, int cell, Use use) const;
  int find_bandwidth(const ActiveGrid<3>& grid, bool wraps) const;
  void fill_band_by_boxes(const ActiveGrid<3>& grid, const std::vector<double>& stiffness);
  void fill_rows(const ActiveGrid<3>& grid, const CellBatches& batches, const std::vector<double>& stiffness);
  void solve_by_rows();

  static constexpr double most_band_operations = 2e10;
  /// A row of S: its cells within two each way; an empty place is the cell itself with 0.
  struct Row {
    std::array<int, 125> cell;
    std::array<float, 125> value;
  };
  std::vector<Row> s_;
  Eigen::VectorXf diagonal_;
  bool by_band_ = true;

  /// Columns of a node's inverse block.
  using Block = std::array<Eigen::Vector4f, 3>;
  static Eigen::Vector4f times(const Block& G, const Eigen::Vector4f& r) {
    return G[0] * r[0] + G[1] * r[1] + G[2] * r[2];
  }

  std::vector<Block> G_inverse_;
  Index<3> way_{};                     ///< the axes, the one that the concrete is longest on first
  std::vector<int> number_;            ///< of each cell in the band
  std::vector<Eigen::Vector4f> rows_;  ///< of the divergences, [27 cell + local node], zero in cells left out
  Eigen::VectorXf y_, p_, p_of_cell_;
  TwoEndedCholesky<float> band_;
};

inline void PressurePreconditioner::number_across_the_thin_way(const ActiveGrid<3>& grid) {
  way_ = {0, 1, 2};
  std::stable_sort(way_.begin(), way_.end(),
                   [&](int a, int b) { return grid.cell_map.extent[a] > grid.cell_map.extent[b]; });
  std::vector<int> by_place(grid.n_cells());
  for (int c = 0; c < grid.n_cells(); ++c) by_place[c] = c;
  std::sort(by_place.begin(), by_place.end(), [&](int a, int b) {
    for (int d : way_)
      if (grid.cell_index[a][d] != grid.cell_index[b][d])
        return grid.cell_index[a][d] < grid.cell_index[b][d];
    return false;
  });
  number_.resize(by_place.size());
  for (std::size_t k = 0; k < by_place.size(); ++k) number_[by_place[k]] = static_cast<int>(k);
}

/// Calls use(cell, offset) for the cells within two of `cell` in every direction, which are those that share
/// a node with it, in the order of their numbers; until one returns false.
template <class Use>
void PressurePreconditioner::for_each_neighbour(const ActiveGrid<3>& grid, int cell, Use use) const {
  const auto [a, b, c] = way_;
  Index<3> offset;
  for (offset[a] = -2; offset[a] <= 2; ++offset[a])
    for (offset[b] = -2; offset[b] <= 2; ++offset[b])
      for (offset[c] = -2; offset[c] <= 2; ++offset[c]) {
        Index<3> other = grid.cell_index[cell];
        for (int d = 0; d < 3; ++d) other[d] = grid.axes[d].cell(other[d] + offset[d]);
        const int o = grid.cell_map.at(other);
        if (o >= 0 && !use(o, offset)) return;
      }
}

inline int PressurePreconditioner::find_bandwidth(const ActiveGrid<3>& grid, bool wraps) const {
  std::vector<int> reach(grid.cell_index.size(), 0);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c)
    for_each_neighbour(grid, c, [&](int other, const Index<3>&) {
      reach[c] = std::max(reach[c], number_[c] - number_[other]);
      return wraps;  // else the first neighbour is the farthest
    });
  return *std::max_element(reach.begin(), reach.end());
}

/// The part of S below its diagonal on a grid whose controls are numbered like its cells: two cells share a
/// box of controls.
inline void PressurePreconditioner::fill_band_by_boxes(const ActiveGrid<3>& grid,
                                                       const std::vector<double>& stiffness) {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    band_.add(number_[c], number_[c], stiffness[c] > 0.0 ? static_cast<float>(1.0 / stiffness[c]) : 1.0f);
    if (stiffness[c] == 0.0) continue;
    std::array<Eigen::Vector4f, 27> w;
    for (int k = 0; k < 27; ++k) w[k] = times(G_inverse_[grid.cell_nodes[c][k]], rows_[27 * c + k]);
    for_each_neighbour(grid, c, [&](int other, const Index<3>& offset) {
      Index<3> low, high;
      for (int d = 0; d < 3; ++d) low[d] = std::max(0, offset[d]), high[d] = std::min(2, 2 + offset[d]);
      const int shift = 27 * other - 9 * offset[0] - 3 * offset[1] - offset[2];
      Eigen::Vector4f sum = Eigen::Vector4f::Zero();
      for (int i = low[0]; i <= high[0]; ++i)
        for (int j = low[1]; j <= high[1]; ++j)
          for (int k = 9 * i + 3 * j + low[2]; k <= 9 * i + 3 * j + high[2]; ++k)
            sum += w[k].cwiseProduct(rows_[shift + k]);
      band_.add(number_[c], number_[other], sum.sum());
      return other != c;  // those behind are entered by themselves
    });
  }
}

/// Row c holds every cell that shares a node with c; each belongs to one thread.
inline void PressurePreconditioner::fill_rows(const ActiveGrid<3>& grid, const CellBatches& batches,
                                              const std::vector<double>& stiffness) {
  s_.resize(by_band_ ? 0 : grid.cell_index.size());
  diagonal_.resize(grid.n_cells());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const float own = stiffness[c] > 0.0 ? static_cast<float>(1.0 / stiffness[c]) : 1.0f;
    const auto add = [&](int other, float value) {
      if (by_band_) return band_.add(number_[c], number_[other], value);
      int place = 0;
      for (int d = 0; d < 3; ++d) place = 5 * place + grid.cell_index[other][d] - grid.cell_index[c][d] + 2;
      s_[c].cell[place] = other;
      s_[c].value[place] += value;
    };
    if (!by_band_) s_[c].cell.fill(c), s_[c].value.fill(0.0f);
    add(c, own);
    for (int k = 0; k < 27 && stiffness[c] > 0.0; ++k) {
      const int i = grid.cell_nodes[c][k];
      const Eigen::Vector4f w = times(G_inverse_[i], rows_[27 * c + k]);
      for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
        if (const int other = *e / 27; !by_band_ || number_[other] <= number_[c])
          add(other, w.dot(rows_[*e]));
    }
    if (!by_band_) diagonal_[c] = s_[c].value[62];
  }
}

inline bool PressurePreconditioner::build(const ActiveGrid<3>& grid, const CellBatches& batches,
                                          const Rows& b, const std::vector<Mat<3, 3>>& G_inverse,
                                          const std::vector<double>& stiffness) {
  G_inverse_.resize(G_inverse.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < G_inverse.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d)
      G_inverse_[i][d] << G_inverse[i].col(static_cast<Eigen::Index>(d)).cast<float>(), 0.0f;
  rows_.resize(27 * grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < 27; ++k)
      rows_[27 * c + k] << (stiffness[c] > 0.0 ? b[c][k] : Vec<3>(Vec<3>::Zero())).cast<float>(), 0.0f;
  mirror_rows(grid);
  number_across_the_thin_way(grid);
  // Rows know their neighbours by place, which a periodic axis repeats.
  bool periodic = false, creased = false;
  for (const Axis& a : grid.axes) periodic = periodic || a.periodic, creased = creased || a.n_creases() > 0;
  const int bandwidth = find_bandwidth(grid, periodic);
  const double n = grid.n_cells(), width = bandwidth;
  by_band_ = periodic || n * width * width < most_band_operations;
  if (by_band_)
    band_.reset(grid.n_cells(), bandwidth);
  else
    for (int c = 0; c < grid.n_cells(); ++c) number_[c] = c;
  by_band_ && !periodic && !creased ? fill_band_by_boxes(grid, stiffness)
                                    : fill_rows(grid, batches, stiffness);
  return !by_band_ || band_.factorise();
}

/// A cell's rows at nodes behind a plane of symmetry join those of the nodes before it, which it sees too.
inline void PressurePreconditioner::mirror_rows(const ActiveGrid<3>& grid) {
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
      rows_[27 * c + of] += sign.cwiseProduct(rows_[27 * c + k]);
      rows_[27 * c + k].setZero();
    }
}

/// p <- S^-1 p to a hundredth, by conjugate gradients on the diagonally scaled S.
inline void PressurePreconditioner::solve_by_rows() {
  const Eigen::Index n = p_.size();
  Eigen::VectorXd r = p_.cast<double>(), z = r.cwiseQuotient(diagonal_.cast<double>()), d = z, Sd(n);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  double rz = block_dot(r, z);
  const double enough = rz / 1e4;
  for (int i = 0; i < 200 && rz > enough; ++i) {
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
                                          const Eigen::VectorXf& r, Eigen::VectorXf& z) {
  const int n = grid.n_cells(), n_nodes = grid.n_nodes();
  z.resize(r.size());
  y_.resize(r.size());
  p_.resize(n);
  p_of_cell_.resize(n);
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int i = 0; i < n_nodes; ++i) y_.segment<4>(4 * i) = times(G_inverse_[i], r.segment<4>(4 * i));
#pragma omp for schedule(static)
    for (int c = 0; c < n; ++c) {
      const auto& nodes = grid.cell_nodes[c];
      Eigen::Vector4f even = Eigen::Vector4f::Zero(), odd = even;
      for (int k = 0; k < 26; k += 2) {
        even += rows_[27 * c + k].cwiseProduct(y_.segment<4>(4 * nodes[k]));
        odd += rows_[27 * c + k + 1].cwiseProduct(y_.segment<4>(4 * nodes[k + 1]));
      }
      even += rows_[27 * c + 26].cwiseProduct(y_.segment<4>(4 * nodes[26]));
      p_[number_[c]] = (even + odd).sum();
    }
    if (by_band_) band_.solve_in_region(p_);
  }
  if (!by_band_) solve_by_rows();
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int c = 0; c < n; ++c) p_of_cell_[c] = p_[number_[c]];
#pragma omp for schedule(static)
    for (int i = 0; i < n_nodes; ++i) {
      Eigen::Vector4f push = Eigen::Vector4f::Zero(), other = push;
      const int *e = batches.entries_begin(i), *end = batches.entries_end(i);
      for (; e + 1 < end; e += 2)
        push += p_of_cell_[e[0] / 27] * rows_[e[0]], other += p_of_cell_[e[1] / 27] * rows_[e[1]];
      if (e != end) push += p_of_cell_[*e / 27] * rows_[*e];
      z.segment<4>(4 * i) = y_.segment<4>(4 * i) - times(G_inverse_[i], push + other);
    }
  }
  for (const MirrorNode<3>& m : grid.mirrors)
    z.segment<3>(4 * m.node) = m.sign.cast<float>().cwiseProduct(z.segment<3>(4 * m.of));
}

}  // namespace tremie
