#pragma once

// The pressures' system S p = (C^-1 + B G^-1 B') p of a body too large for a factor: conjugate gradients
// with its entries, preconditioned on two levels.
//
// S is a Laplacian of the pressures with a little softness C^-1. What reaches over single cells is taken out
// by F' F, which comes near S^-1 (fsai.hpp); what is smooth over five cells by a second level: one
// pressure for each cube of five cells a direction, P' S P, a narrow band with a 125th of the unknowns,
// which is factorised. Both have part in what is smooth, so that the second one counts half:
//
//   M^-1 = F' F + 1/2 P (P' S P)^-1 P'.

#include "libmpm/implicit/schur/fsai.hpp"
#include "libmpm/implicit/schur/matrix.hpp"
#include "libmpm/linear/conjugate_gradients.hpp"
#include "libmpm/linear/twisted_cholesky.hpp"

namespace tremie {

class TwoLevelPcg {
 public:
  static constexpr int cube = 5;  ///< cells a direction

  /// From `entries`; false where the second level is not positive definite.
  bool build(const ActiveGrid<3>& grid);
  /// p <- S^-1 p, its residual's energy norm reduced by `reduction`.
  void solve(double reduction, Eigen::VectorXf& p);

  SchurMatrix entries;  ///< S

 private:
  void find_aggregates(const ActiveGrid<3>& grid);
  void fill_coarse();
  void multiply(const Eigen::VectorXf& p, Eigen::VectorXf& Sp);
  void precondition(const Eigen::VectorXf& r, Eigen::VectorXf& z);

  Fsai near_;
  Eigen::VectorXf coarse_;
  std::vector<int> cube_;  ///< of each cell
  std::vector<int>
      aggregate_begin_;  ///< cells aggregate_cell_[aggregate_begin_[k] .. aggregate_begin_[k + 1]) are in cube k
  std::vector<int> aggregate_cell_;
  TwistedCholesky band_;
};

}  // namespace tremie
