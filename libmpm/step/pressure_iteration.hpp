#pragma once

// The pressures' system S p = (C^-1 + B G^-1 B') p of a body too large for a factor: conjugate gradients
// without a matrix, preconditioned on two levels.
//
// S is a Laplacian of the pressures with a little softness C^-1, so that its diagonal alone leaves as many
// iterations as the pressure reaches cells, a hundred for a stiff bulk modulus and a long step. What is
// smooth over three cells is taken out by a second level: one pressure for each cube of three cells a
// direction, P' S P, a narrow band with a twenty-seventh of the unknowns, which is factorised:
//
//   M^-1 = diag(S)^-1 + P (P' S P)^-1 P'.

#include "libmpm/step/conjugate_gradients.hpp"
#include "libmpm/step/pressure_rows.hpp"
#include "libmpm/step/two_ended_cholesky.hpp"

namespace tremie {

class PressureIteration {
 public:
  static constexpr int cube = 3;  ///< cells a direction

  /// False where the second level is not positive definite.
  bool build(const ActiveGrid<3>& grid, const CellBatches& batches, const PressureRows& rows);
  /// p <- S^-1 p, its residual's energy norm reduced by `reduction`.
  void solve(const ActiveGrid<3>& grid, const CellBatches& batches, const PressureRows& rows,
             double reduction, Eigen::VectorXf& p);

 private:
  void find_cubes(const ActiveGrid<3>& grid);
  void fill_coarse(const ActiveGrid<3>& grid, const CellBatches& batches, const PressureRows& rows);
  void multiply(const ActiveGrid<3>& grid, const CellBatches& batches, const PressureRows& rows,
                const Eigen::VectorXf& p, Eigen::VectorXf& Sp);
  void precondition(const Eigen::VectorXf& r, Eigen::VectorXf& z);

  Eigen::VectorXf inverse_diagonal_, y_, coarse_;
  std::vector<int> cube_;        ///< of each cell
  std::vector<int> cube_begin_;  ///< cells cube_cell_[cube_begin_[k] .. cube_begin_[k + 1]) are in cube k
  std::vector<int> cube_cell_;
  TwoEndedCholesky<float> band_;
};

/// Numbers the cubes with the shortest way across the body running fastest.
inline void PressureIteration::find_cubes(const ActiveGrid<3>& grid) {
  Index<3> way{0, 1, 2};
  std::stable_sort(way.begin(), way.end(),
                   [&](int a, int b) { return grid.cell_map.extent[a] > grid.cell_map.extent[b]; });
  const int n = grid.n_cells();
  std::vector<Index<3>> at(n);
  for (int c = 0; c < n; ++c)
    for (int d = 0; d < 3; ++d) at[c][d] = (grid.cell_index[c][way[d]] - grid.cell_map.low[way[d]]) / cube;
  cube_cell_.resize(n);
  for (int c = 0; c < n; ++c) cube_cell_[c] = c;
  std::sort(cube_cell_.begin(), cube_cell_.end(),
            [&](int a, int b) { return at[a] != at[b] ? at[a] < at[b] : a < b; });
  cube_.resize(n);
  cube_begin_.clear();
  for (int k = 0; k < n; ++k) {
    if (k == 0 || at[cube_cell_[k]] != at[cube_cell_[k - 1]]) cube_begin_.push_back(k);
    cube_[cube_cell_[k]] = static_cast<int>(cube_begin_.size()) - 1;
  }
  cube_begin_.push_back(n);
}

/// P' S P: the cells of a cube that see a node act on it as one.
inline void PressureIteration::fill_coarse(const ActiveGrid<3>& grid, const CellBatches& batches,
                                           const PressureRows& rows) {
  struct Share {
    int cube;
    Eigen::Vector4f row;
  };
  std::vector<Share> share;
  const auto cubes_of = [&](int i) {
    share.clear();
    for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e) {
      const int k = cube_[*e / 27];
      auto s = std::find_if(share.begin(), share.end(), [&](const Share& one) { return one.cube == k; });
      if (s == share.end()) s = share.insert(s, {k, Eigen::Vector4f::Zero()});
      s->row += rows.row[*e];
    }
  };
  int bandwidth = 0;
  for (int i = 0; i < grid.n_nodes(); ++i) {
    int low = cube_[*batches.entries_begin(i) / 27], high = low;
    for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
      low = std::min(low, cube_[*e / 27]), high = std::max(high, cube_[*e / 27]);
    bandwidth = std::max(bandwidth, high - low);
  }
  const int n = static_cast<int>(cube_begin_.size()) - 1;
  band_.reset(n, bandwidth);
  coarse_.setZero(n);
  for (int c = 0; c < grid.n_cells(); ++c) band_.add(cube_[c], cube_[c], rows.softness[c]);
  for (int i = 0; i < grid.n_nodes(); ++i) {
    cubes_of(i);
    for (const Share& a : share) {
      const Eigen::Vector4f w = PressureRows::times(rows.G_inverse[i], a.row);
      for (const Share& b : share)
        if (b.cube <= a.cube) band_.add(a.cube, b.cube, w.dot(b.row));
    }
  }
}

inline bool PressureIteration::build(const ActiveGrid<3>& grid, const CellBatches& batches,
                                     const PressureRows& rows) {
  inverse_diagonal_.resize(grid.n_cells());
  y_.resize(4 * grid.n_nodes());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    for (int k = 0; k < 27; ++k)
      sum += rows.row[27 * c + k].cwiseProduct(
          PressureRows::times(rows.G_inverse[grid.cell_nodes[c][k]], rows.row[27 * c + k]));
    inverse_diagonal_[c] = 1.0f / (rows.softness[c] + sum.sum());
  }
  find_cubes(grid);
  fill_coarse(grid, batches, rows);
  return band_.factorise();
}

inline void PressureIteration::multiply(const ActiveGrid<3>& grid, const CellBatches& batches,
                                        const PressureRows& rows, const Eigen::VectorXf& p,
                                        Eigen::VectorXf& Sp) {
  const int n = grid.n_cells(), n_nodes = grid.n_nodes();
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int i = 0; i < n_nodes; ++i)
      y_.segment<4>(4 * i) = PressureRows::times(rows.G_inverse[i], rows.push(batches, i, p));
#pragma omp for schedule(static)
    for (int c = 0; c < n; ++c) Sp[c] = rows.softness[c] * p[c] + rows.divergence(grid, c, y_);
  }
}

inline void PressureIteration::precondition(const Eigen::VectorXf& r, Eigen::VectorXf& z) {
  const int n = static_cast<int>(coarse_.size());
  z.resize(r.size());
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int k = 0; k < n; ++k) {
      coarse_[k] = 0.0f;
      for (int j = cube_begin_[k]; j < cube_begin_[k + 1]; ++j) coarse_[k] += r[cube_cell_[j]];
    }
    band_.solve_in_region(coarse_);
#pragma omp for schedule(static)
    for (Eigen::Index c = 0; c < r.size(); ++c)
      z[c] = inverse_diagonal_[c] * r[c] + coarse_[cube_[static_cast<std::size_t>(c)]];
  }
}

inline void PressureIteration::solve(const ActiveGrid<3>& grid, const CellBatches& batches,
                                     const PressureRows& rows, double reduction, Eigen::VectorXf& p) {
  Eigen::VectorXf rest = p;
  conjugate_gradients(
      [&](const Eigen::VectorXf& x, Eigen::VectorXf& Sx) { multiply(grid, batches, rows, x, Sx); },
      [&](const Eigen::VectorXf& r, Eigen::VectorXf& z) { precondition(r, z); },
      {.reduction = reduction, .most = 200}, rest, p);
}

}  // namespace tremie
