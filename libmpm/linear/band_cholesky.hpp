#pragma once

// Cholesky factorisation of a symmetric positive definite band matrix, in dense blocks.
//
// A body of concrete is long one way and thin the other; with the nodes numbered across its thin way its
// matrix is a narrow band, and dense kernels on that band beat a sparse factorisation that touches fewer
// numbers one by one (three times on a slump of 1,900 cells). Eigen has no band solver; this is the textbook
// right-looking one on its dense blocks.

#include <Eigen/Core>
#include <vector>

namespace tremie {

class BandCholesky {
 public:
  static constexpr int block = 32;

  /// Allocates n unknowns coupled over at most `bandwidth` rows below the diagonal; all entries zero.
  void reset(int n, int bandwidth);
  /// Adds to the entry (i, j), i >= j.
  void add(int i, int j, double value) { columns_[j / block](i - j / block * block, j % block) += value; }
  /// In place; false where the matrix is not positive definite.
  bool factorise();
  /// Solves for x in place.
  void solve(Eigen::VectorXd& x) const;

 private:
  int n_ = 0, below_ = 0;
  std::vector<Eigen::MatrixXd> columns_;  ///< block column k: rows from its diagonal block downwards
};

}  // namespace tremie
