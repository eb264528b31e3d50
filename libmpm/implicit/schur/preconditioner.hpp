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
// with one unknown a cell in S, the pressures, coupled over two cells each way. For bodies of up to some
// thousand cells S is factorised as a band. The band's n b^2 operations grow like n^(7/3); beyond, S is
// solved by conjugate gradients of its own (two_level_pcg.hpp).

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "libmpm/implicit/schur/divergence_operator.hpp"
#include "libmpm/implicit/schur/two_level_pcg.hpp"

namespace tremie {

class SchurComplementPreconditioner {
 public:
  /// `G_inverse`: node blocks, zero where a wall prescribes; `stiffness`: C [J s], a cell with 0 is left out;
  /// `ratio`: of the largest C to the stiffness of D in a cell. False where S is not positive definite.
  bool build(const ActiveGrid<3>& grid, const CellBatches& batches, const Quadrature<ThreeD>& quadrature,
             const std::vector<Mat<3, 3>>& G_inverse, const std::vector<double>& stiffness, double ratio);
  /// Decides whether S is to be factorised: up to so many operations. Before build().
  void lay_out(const ActiveGrid<3>& grid, double most_band_operations);
  bool factorised() const { return by_band_; }
  /// Gives back the memory of a large body until the next build(); false if it is none.
  bool release() {
    if (by_band_) return false;
    rows_ = {};
    iteration_ = {};
    tremie::release(number_);
    y_.resize(0), p_.resize(0);
    return true;
  }
  const DivergenceOperator& rows() const { return rows_; }
  /// z = P^-1 r, four numbers a node; `buffer`: of the batches' chunks.
  void apply(const CellBatches& batches, const ActiveGrid<3>& grid, const Eigen::VectorXf& r,
             ReductionBuffer& buffer, Eigen::VectorXf& z);

 private:
  void order_across_the_thin_way(const ActiveGrid<3>& grid);
  void number_cells(const std::vector<char>& left_out);
  template <class Use>
  void for_each_neighbour(const ActiveGrid<3>& grid, int cell, Use use) const;
  void find_first_columns(const ActiveGrid<3>& grid);
  template <class Add>
  void fill_by_boxes(const ActiveGrid<3>& grid, Add add) const;
  template <class Add>
  void fill_by_nodes(const ActiveGrid<3>& grid, const CellBatches& batches, Add add) const;
  template <class Add>
  void fill(const ActiveGrid<3>& grid, const CellBatches& batches, Add add) const;
  bool by_band_ = true;
  double reduction_ = 1e-2;  ///< of the residual in a solve with S by iteration

  Index<3> way_{};           ///< the axes, the one that the concrete is longest on first
  std::vector<int> order_;   ///< the cells as the band has them
  std::vector<int> number_;  ///< of each cell in the band; -1 where it is left out
  DivergenceOperator rows_;
  TwoLevelPcg iteration_;  ///< where S is not factorised
  Eigen::VectorXf y_, p_;
  std::vector<int> first_;  ///< of each row of the band: its first column
  TwistedCholesky band_;
};

}  // namespace tremie
