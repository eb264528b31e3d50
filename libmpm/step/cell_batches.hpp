#pragma once

// Velocity gradients and their adjoint at the Gauss places of all cells in space, without a matrix.
//
// Quadratic splines are products of one spline a direction, so the 27 controls of a cell are contracted one
// direction at a time: about 1,000 operations for the nine gradient components at eight places where the rows
// of the strain matrix would cost 3,200. Cells are taken eight at a time, one a vector lane. What a cell
// gives its nodes is stored, and each node adds up its cells in their order: the bits do not depend on the
// threads.

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <vector>

#include "libmpm/grid/active_grid.hpp"

namespace tremie {

inline constexpr int n_lanes = 8;
using Lanes = Eigen::Array<double, n_lanes, 1>;

/// Gradients g[d][e][k] = d v_d / d x_e at Gauss place k of a batch of cells, or the stresses that work on
/// them.
struct PlaceTensors {
  Lanes g[3][3][8];
};

class CellBatches {
 public:
  /// Lays the batches out for a grid.
  void lay_out(const ActiveGrid<3>& grid);

  int n_cells() const { return n_cells_; }
  int n_nodes() const { return n_nodes_; }
  int n_batches() const { return static_cast<int>(nodes_.size()); }

  /// Gradients of the nodal vector field v (3 values a node) in a batch.
  void gradients(int batch, const double* v, PlaceTensors& out) const;
  /// Gives each node of the batch's cells sum_k T_k grad N, stored for add_to_nodes().
  void scatter(int batch, const PlaceTensors& T);
  /// Sum at node i of what its cells were given.
  Vec<3> gathered(int i) const {
    Vec<3> sum = Vec<3>::Zero();
    for (int e = node_begin_[i]; e < node_begin_[i + 1]; ++e)
      sum += Eigen::Map<const Vec<3>>(&local_[3 * static_cast<std::size_t>(node_entry_[e])]);
    return sum;
  }
  /// Cells of node i in their order, as 27 cell + local node.
  const int* entries_begin(int i) const { return &node_entry_[node_begin_[i]]; }
  const int* entries_end(int i) const { return node_entry_.data() + node_begin_[i + 1]; }

 private:
  // The three splines of a direction as seen from the middle control u1: with a = f (u0 - u1), c = g (u2 -
  // u1) and f, g = 2 at a wall and 1 elsewhere, a value is u1 + t^2/2 a + s^2/2 c and a slope (s c - t a)/h,
  // t = 1 - s.
  static constexpr double near = 0.78867513459481288, far = 1.0 - near;
  static constexpr double near2 = 0.5 * near * near, far2 = 0.5 * far * far;

  using Nodes = std::array<std::array<int, n_lanes>, 27>;
  struct Ends {
    Lanes low[3], high[3];
  };

  int n_cells_ = 0, n_nodes_ = 0;
  double inverse_h_[3] = {1.0, 1.0, 1.0};
  std::vector<Nodes> nodes_;
  std::vector<Ends> ends_;
  std::vector<int> node_begin_, node_entry_;
  std::vector<double> local_;  ///< [cell][local node][3]
};

inline void CellBatches::lay_out(const ActiveGrid<3>& grid) {
  n_cells_ = grid.n_cells();
  n_nodes_ = grid.n_nodes();
  for (int d = 0; d < 3; ++d) inverse_h_[d] = 1.0 / grid.axes[d].h;
  const int n = (n_cells_ + n_lanes - 1) / n_lanes;
  nodes_.resize(n);
  ends_.resize(n);
#pragma omp parallel for schedule(static)
  for (int b = 0; b < n; ++b)
    for (int l = 0; l < n_lanes; ++l) {
      const int c = std::min(b * n_lanes + l, n_cells_ - 1);  // lanes beyond the last cell repeat it, unheard
      for (int k = 0; k < 27; ++k) nodes_[b][k][l] = grid.cell_nodes[c][k];
      for (int d = 0; d < 3; ++d) {
        const Axis& a = grid.axes[d];
        const int i = grid.cell_index[c][d];
        ends_[b].low[d][l] = a.wall_low() && i == 0 ? 2.0 : 1.0;
        ends_[b].high[d][l] = a.wall_high() && i == a.n_cells - 1 ? 2.0 : 1.0;
      }
    }
  node_begin_.assign(n_nodes_ + 1, 0);
  for (const auto& nodes : grid.cell_nodes)
    for (int i : nodes) ++node_begin_[i + 1];
  for (int i = 0; i < n_nodes_; ++i) node_begin_[i + 1] += node_begin_[i];
  node_entry_.resize(static_cast<std::size_t>(n_cells_) * 27);
  std::vector<int> next(node_begin_.begin(), node_begin_.end() - 1);
  for (int c = 0; c < n_cells_; ++c)
    for (int k = 0; k < 27; ++k) node_entry_[next[grid.cell_nodes[c][k]]++] = c * 27 + k;
  local_.resize(static_cast<std::size_t>(n_cells_) * 81);
}

inline void CellBatches::gradients(int batch, const double* v, PlaceTensors& out) const {
  const Nodes& nodes = nodes_[batch];
  const Ends& ends = ends_[batch];
  Lanes u[3][27];
  for (int k = 0; k < 27; ++k)
    for (int l = 0; l < n_lanes; ++l) {
      const double* at = v + 3 * static_cast<std::ptrdiff_t>(nodes[k][l]);
      u[0][k][l] = at[0], u[1][k][l] = at[1], u[2][k][l] = at[2];
    }
  for (int d = 0; d < 3; ++d) {
    Lanes X[2][9], dX[2][9];
    for (int j = 0; j < 9; ++j) {
      const Lanes a = ends.low[0] * (u[d][j] - u[d][9 + j]), c = ends.high[0] * (u[d][18 + j] - u[d][9 + j]);
      X[0][j] = u[d][9 + j] + near2 * a + far2 * c;
      X[1][j] = u[d][9 + j] + far2 * a + near2 * c;
      dX[0][j] = inverse_h_[0] * (far * c - near * a);
      dX[1][j] = inverse_h_[0] * (near * c - far * a);
    }
    for (int p = 0; p < 2; ++p) {
      Lanes XY[2][3], XdY[2][3], dXY[2][3];
      for (int k = 0; k < 3; ++k) {
        const Lanes a = ends.low[1] * (X[p][k] - X[p][3 + k]), c = ends.high[1] * (X[p][6 + k] - X[p][3 + k]);
        XY[0][k] = X[p][3 + k] + near2 * a + far2 * c;
        XY[1][k] = X[p][3 + k] + far2 * a + near2 * c;
        XdY[0][k] = inverse_h_[1] * (far * c - near * a);
        XdY[1][k] = inverse_h_[1] * (near * c - far * a);
        const Lanes da = ends.low[1] * (dX[p][k] - dX[p][3 + k]),
                    dc = ends.high[1] * (dX[p][6 + k] - dX[p][3 + k]);
        dXY[0][k] = dX[p][3 + k] + near2 * da + far2 * dc;
        dXY[1][k] = dX[p][3 + k] + far2 * da + near2 * dc;
      }
      for (int q = 0; q < 2; ++q) {
        const int lo = p + 2 * q, hi = lo + 4;
        const auto value = [&](const Lanes* w, Lanes& low, Lanes& high) {
          const Lanes a = ends.low[2] * (w[0] - w[1]), c = ends.high[2] * (w[2] - w[1]);
          low = w[1] + near2 * a + far2 * c;
          high = w[1] + far2 * a + near2 * c;
        };
        value(dXY[q], out.g[d][0][lo], out.g[d][0][hi]);
        value(XdY[q], out.g[d][1][lo], out.g[d][1][hi]);
        const Lanes a = ends.low[2] * (XY[q][0] - XY[q][1]), c = ends.high[2] * (XY[q][2] - XY[q][1]);
        out.g[d][2][lo] = inverse_h_[2] * (far * c - near * a);
        out.g[d][2][hi] = inverse_h_[2] * (near * c - far * a);
      }
    }
  }
}

inline void CellBatches::scatter(int batch, const PlaceTensors& T) {
  const Ends& ends = ends_[batch];
  Lanes u[3][27];
  // A value's adjoint gives a, c and u1 their shares of X0, X1; a slope's those of D0, D1.
  const auto adjoint = [](const Lanes& low, const Lanes& high, const Lanes& a, const Lanes& c,
                          const Lanes& sum, Lanes& u0, Lanes& u1, Lanes& u2) {
    u0 = low * a;
    u2 = high * c;
    u1 = sum - u0 - u2;
  };
  for (int d = 0; d < 3; ++d) {
    Lanes X[2][9], dX[2][9];
    for (int p = 0; p < 2; ++p) {
      Lanes XY[2][3], XdY[2][3], dXY[2][3];
      for (int q = 0; q < 2; ++q) {
        const int lo = p + 2 * q, hi = lo + 4;
        const auto value = [&](const Lanes& x0, const Lanes& x1, Lanes* w) {
          adjoint(ends.low[2], ends.high[2], near2 * x0 + far2 * x1, far2 * x0 + near2 * x1, x0 + x1, w[0],
                  w[1], w[2]);
        };
        value(T.g[d][0][lo], T.g[d][0][hi], dXY[q]);
        value(T.g[d][1][lo], T.g[d][1][hi], XdY[q]);
        const Lanes d0 = inverse_h_[2] * T.g[d][2][lo], d1 = inverse_h_[2] * T.g[d][2][hi];
        adjoint(ends.low[2], ends.high[2], -near * d0 - far * d1, far * d0 + near * d1, Lanes::Zero(),
                XY[q][0], XY[q][1], XY[q][2]);
      }
      for (int k = 0; k < 3; ++k) {
        const Lanes d0 = inverse_h_[1] * XdY[0][k], d1 = inverse_h_[1] * XdY[1][k];
        const Lanes &x0 = XY[0][k], &x1 = XY[1][k];
        adjoint(ends.low[1], ends.high[1], near2 * x0 + far2 * x1 - near * d0 - far * d1,
                far2 * x0 + near2 * x1 + far * d0 + near * d1, x0 + x1, X[p][k], X[p][3 + k], X[p][6 + k]);
        const Lanes &y0 = dXY[0][k], &y1 = dXY[1][k];
        adjoint(ends.low[1], ends.high[1], near2 * y0 + far2 * y1, far2 * y0 + near2 * y1, y0 + y1, dX[p][k],
                dX[p][3 + k], dX[p][6 + k]);
      }
    }
    for (int j = 0; j < 9; ++j) {
      const Lanes d0 = inverse_h_[0] * dX[0][j], d1 = inverse_h_[0] * dX[1][j];
      const Lanes &x0 = X[0][j], &x1 = X[1][j];
      adjoint(ends.low[0], ends.high[0], near2 * x0 + far2 * x1 - near * d0 - far * d1,
              far2 * x0 + near2 * x1 + far * d0 + near * d1, x0 + x1, u[d][j], u[d][9 + j], u[d][18 + j]);
    }
  }
  const int count = std::min(n_lanes, n_cells_ - batch * n_lanes);
  for (int l = 0; l < count; ++l) {
    double* out = &local_[81 * (static_cast<std::size_t>(batch) * n_lanes + static_cast<std::size_t>(l))];
    for (int k = 0; k < 27; ++k)
      out[3 * k] = u[0][k][l], out[3 * k + 1] = u[1][k][l], out[3 * k + 2] = u[2][k][l];
  }
}

}  // namespace tremie
