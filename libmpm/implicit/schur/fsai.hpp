#pragma once

// What comes near the inverse of the pressures' matrix S, in factors: S^-1 ~ F' F (Kolotilina and
// Yeremin, SIAM J. Matrix Anal. Appl. 14, 1993), symmetric and positive definite whatever F leaves out.
//
// F has seven entries a cell: with itself and with the first and second cell ahead along each axis. In the
// inside of a body a wave of pressure with phases theta a cell meets in S
//
//   sum over axes d of  sin^2 theta_d  times  ((2 + cos theta_e) / 3)^2  over the other axes e:
//
// sin^2 couples second neighbours, and where the pressure alternates from cell to cell along two axes the
// rest makes 1/81 of what it is for a smooth one. A diagonal sees neither, and leaves twice the iterations.

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "libmpm/implicit/schur/matrix.hpp"

namespace tremie {

class Fsai {
 public:
  void build(const SchurMatrix& S);
  /// Leaves F' F r in layout.x, by place, and uses layout.y; `layout` is that of the S it was built from. To
  /// be called by all threads of a parallel region.
  void apply_in_region(CellColumns& layout, const Eigen::VectorXf& r) const;

 private:
  using Column = CellColumns::Column;
  static constexpr int kept = 7, slack = CellColumns::slack;
  static constexpr std::array<Index<3>, kept> ahead{
      {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 0}, {0, 2, 0}, {1, 0, 0}, {2, 0, 0}}};

  /// Entry k of the cell at low + i of a column is [k size + i] of what this returns.
  const float* of_column(const Column& column) const { return &entries_[slack + kept * column.first]; }
  float* of_column(const Column& column) { return &entries_[slack + kept * column.first]; }
  using Columns = std::array<const Column*, kept>;  ///< of the cells of a row of F; null where none
  using Row = std::array<const float*, kept>;
  static Row row_of(const SchurMatrix& S, const Columns& there, int place);
  static Mat<kept, kept> part_of(const Columns& there, const Row& row);
  void fill_column(const SchurMatrix& S, const Column& column);
  void multiply_column(CellColumns& layout, const Column& column) const;
  void transposed_column(CellColumns& layout, const Column& column) const;

  std::vector<float> entries_;
};

}  // namespace tremie
