#pragma once

// ADMM stress and rate of 3D, in the memory of one of them.
//
// Stress s and rate d at a quadrature point come out of one vector, a = s + r (rho q + (1 - rho) d) before them:
//
//   d = prox(|a|) a/|a|,   s = a - r d,
//
// so that a is kept, with the yield stress and the penalty that belong to it, and the two are made again
// where they are used. By batches of cells, as the solver goes through them.

#include <cmath>
#include <vector>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/grid/active_grid.hpp"
#include "libmpm/implicit/matrix_free/cell_simd.hpp"

namespace tremie {

struct PackedAdmmState {
  struct Batch {
    Lanes<double> a[8][5], tau_y[8];
  };
  std::vector<Batch> batch;
  double r = 1.0;  ///< the penalty of a [Pa s]

  bool empty() const { return batch.empty(); }
};

namespace detail {

template <class Scalar>
Lanes<Scalar> norm(const Lanes<Scalar> (&q)[5]) {
  Lanes<Scalar> n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] + q[4] * q[4];
  for (int l = 0; l < batch_size; ++l) n[l] = std::sqrt(n[l]);
  return n;
}

// GCC takes what AVX-512 leaves unset on purpose for a mistake of Eigen's.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
inline double sum_of(const Lanes<double>& lanes) { return lanes.sum(); }
#pragma GCC diagnostic pop

/// Stress and rate that a stands for.
template <class Law>
void unpack_stress_and_rate(const Law& law, const Lanes<double> (&a)[5], const Lanes<double>& tau_y, double r,
                            Lanes<double> (&s)[5], Lanes<double> (&d)[5]) {
  const Lanes<double> size = norm(a);
  Lanes<double> factor;
  for (int l = 0; l < batch_size; ++l)
    factor[l] = size[l] > 0.0 ? law.prox(size[l], tau_y[l], r) / size[l] : 0.0;
  for (int j = 0; j < 5; ++j) {
    d[j] = factor * a[j];
    s[j] = a[j] - r * d[j];
  }
}

/// Unstressed ADMM state of so many cells.
inline PackedAdmmState zero_admm_state(int n_cells) {
  PackedAdmmState admm_state;
  admm_state.batch.resize((n_cells + batch_size - 1) / batch_size);
  for (PackedAdmmState::Batch& b : admm_state.batch)
    for (int k = 0; k < 8; ++k) {
      b.tau_y[k].setZero();
      for (Lanes<double>& a : b.a[k]) a.setZero();
    }
  return admm_state;
}

/// Cells that were active before go on from where they were; new cells start unstressed.
inline PackedAdmmState carried(const IndexMap<3>& old_map, const ActiveGrid<3>& grid,
                               const PackedAdmmState& old) {
  PackedAdmmState now = zero_admm_state(grid.n_cells());
  now.r = old.r;
  if (old.empty()) return now;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const int from = old_map.at(grid.cell_index[c]);
    if (from < 0) continue;
    const PackedAdmmState::Batch& b = old.batch[from / batch_size];
    PackedAdmmState::Batch& to = now.batch[c / batch_size];
    const int l = from % batch_size, lane = c % batch_size;
    for (int k = 0; k < 8; ++k) {
      to.tau_y[k][lane] = b.tau_y[k][l];
      for (int j = 0; j < 5; ++j) to.a[k][j][lane] = b.a[k][j][l];
    }
  }
  return now;
}

/// The stress at quadrature point k of cell c.
inline Vec<5> stress_of(const YieldLaw& law, const PackedAdmmState& admm_state, int c, int k) {
  const PackedAdmmState::Batch& b = admm_state.batch[c / batch_size];
  const int l = c % batch_size;
  Vec<5> a;
  for (int j = 0; j < 5; ++j) a[j] = b.a[k][j][l];
  const double size = a.norm();
  return size > 0.0 ? Vec<5>(a - admm_state.r * prox(law, size, b.tau_y[k][l], admm_state.r) / size * a) : a;
}

}  // namespace detail

}  // namespace tremie
