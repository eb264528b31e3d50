#pragma once

// Velocity gradients and their adjoint at the quadrature points of all cells in 3D, without a matrix.
//
// Quadratic splines are products of one spline a direction, so the 27 nodes of a cell are contracted one
// direction at a time: about 1,000 operations for the nine gradient components at eight quadrature points where the rows
// of the strain matrix would cost 3,200. Cells are taken sixteen at a time, one a vector lane, in double
// precision or, for the products of a linear solve, in single.

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/grid/node_reduction.hpp"
#include "libmpm/implicit/matrix_free/cell_simd.hpp"
#include "libmpm/parallel/buffers.hpp"

namespace tremie {

/// Gradients g[d][e][k] = d v_d / d x_e at quadrature point k of a batch of cells, or the stresses that work on
/// them.
template <class Scalar>
struct QuadratureTensors {
  Lanes<Scalar> g[3][3][8];
};

class CellBatches {
 public:
  /// Lays the batches out for a grid.
  void lay_out(const ActiveGrid<3>& grid);

  int n_cells() const { return n_cells_; }
  int n_batches() const { return static_cast<int>(ends_.size()); }
  /// Chunk of whole batches.
  const NodeReduction& reduction() const { return reduction_; }
  int first_batch(int chunk) const { return reduction_.first_cell(chunk) / batch_size; }
  int last_batch(int chunk) const { return (reduction_.last_cell(chunk) + batch_size - 1) / batch_size; }

  /// Gradients of the nodal vector field v in a batch. Scalar is float or double.
  template <class Scalar>
  void gradients(int batch, const Scalar* v, QuadratureTensors<Scalar>& out) const;
  /// Adds sum_k T_k grad N to each node of the batch's cells; `to`: its chunk's nodes.
  template <class Scalar>
  void scatter(int batch, const QuadratureTensors<Scalar>& T, Scalar* to) const;
  /// Cells of node i in their order: cell_of() and local_of() tell what an entry means.
  const int* entries_begin(int i) const { return &node_entry_[node_begin_[i]]; }
  const int* entries_end(int i) const { return node_entry_.data() + node_begin_[i + 1]; }
  static int cell_of(int entry) { return entry / of_cell; }
  static int local_of(int entry) { return entry % of_cell; }

 private:
  // The three splines of a direction as seen from the middle node u1: with a = f (u0 - u1), c = g (u2 -
  // u1) and f, g = 2 at a wall and 1 elsewhere, a value is u1 + t^2/2 a + s^2/2 c and a slope (s c - t a)/h,
  // t = 1 - s.
  static constexpr double near_ = 0.78867513459481288, far_ = 1.0 - near_;

  static constexpr int of_cell = 32;  ///< numbers of a cell's entries, of which 27 are used

  /// Local nodes 3 j, 3 j + 1, 3 j + 2 of a cell follow each other in number too, unless the last axis is
  /// periodic: of nine lines the first nodes are kept, else all 27.
  using Nodes = std::array<int, batch_size>;
  int kept_nodes() const { return lines_ ? 9 : 27; }
  struct Ends {
    Lanes<float> low[3], high[3];
  };
  template <class Scalar>
  struct Factors {
    Lanes<Scalar> low[3], high[3];
    Scalar inverse_h[3];
  };
  template <class Scalar>
  Factors<Scalar> factors(int batch) const {
    Factors<Scalar> f;
    for (int d = 0; d < 3; ++d) {
      f.low[d] = ends_[batch].low[d].cast<Scalar>(), f.high[d] = ends_[batch].high[d].cast<Scalar>();
      f.inverse_h[d] = static_cast<Scalar>(inverse_h_[d]);
    }
    return f;
  }

  int n_cells_ = 0;
  double inverse_h_[3] = {1.0, 1.0, 1.0};
  bool lines_ = true;
  std::vector<Nodes> nodes_;  ///< kept_nodes() of each batch
  std::vector<Ends> ends_;
  std::vector<int> node_begin_, node_entry_;
  NodeReduction reduction_;
};

}  // namespace tremie
