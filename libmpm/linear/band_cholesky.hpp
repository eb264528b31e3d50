#pragma once

// Cholesky factorisation of a symmetric positive definite band matrix, in dense blocks.
//
// A body of concrete is long one way and thin the other; with the nodes numbered across its thin way its
// matrix is a narrow band, and dense kernels on that band beat a sparse factorisation that touches fewer
// numbers one by one (three times on a slump of 1,900 cells). Eigen has no band solver; this is the textbook
// right-looking one on its dense blocks.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

namespace tremie {

template <class Scalar>
class BandCholesky {
 public:
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  static constexpr int block = 32;

  /// Allocates n unknowns coupled over at most `bandwidth` rows below the diagonal; all entries zero.
  void reset(int n, int bandwidth) {
    n_ = n;
    below_ = (bandwidth + block - 1) / block * block;
    columns_.resize((n + block - 1) / block);
    for (Matrix& c : columns_) c.setZero(block + below_, block);
    // Unknowns that only fill up the last block are decoupled.
    for (int i = n; i < static_cast<int>(columns_.size()) * block; ++i) add(i, i, Scalar(1));
  }
  /// Adds to the entry (i, j), i >= j.
  void add(int i, int j, Scalar value) { columns_[j / block](i - j / block * block, j % block) += value; }

  /// In place; false where the matrix is not positive definite.
  bool factorise() {
    const int n_blocks = static_cast<int>(columns_.size());
    for (int k = 0; k < n_blocks; ++k) {
      auto diagonal = columns_[k].template topRows<block>();
      const Eigen::LLT<Matrix> llt(diagonal);
      if (llt.info() != Eigen::Success) return false;
      diagonal = llt.matrixLLT();
      const int rows = std::min(below_, (n_blocks - 1 - k) * block);
      auto panel = columns_[k].middleRows(block, rows);
      diagonal.template triangularView<Eigen::Lower>().transpose().template solveInPlace<Eigen::OnTheRight>(
          panel);
#pragma omp parallel for schedule(dynamic) if (rows > 600)
      for (int j = 0; j < rows / block; ++j)
        columns_[k + 1 + j].topRows(rows - j * block).noalias() -=
            panel.bottomRows(rows - j * block) * panel.middleRows(j * block, block).transpose();
    }
    return true;
  }
  /// Solves for x in place.
  void solve(Vector& x) const {
    const int n_blocks = static_cast<int>(columns_.size());
    x.conservativeResizeLike(Vector::Zero(n_blocks * block));
    for (int k = 0; k < n_blocks; ++k) {
      const int rows = std::min(below_, (n_blocks - 1 - k) * block);
      auto part = x.template segment<block>(k * block);
      columns_[k].template topRows<block>().template triangularView<Eigen::Lower>().solveInPlace(part);
      x.segment((k + 1) * block, rows).noalias() -= columns_[k].middleRows(block, rows) * part;
    }
    for (int k = n_blocks - 1; k >= 0; --k) {
      const int rows = std::min(below_, (n_blocks - 1 - k) * block);
      auto part = x.template segment<block>(k * block);
      part.noalias() -= columns_[k].middleRows(block, rows).transpose() * x.segment((k + 1) * block, rows);
      columns_[k].template topRows<block>().template triangularView<Eigen::Lower>().transpose().solveInPlace(
          part);
    }
    x.conservativeResize(n_);
  }

 private:
  int n_ = 0, below_ = 0;
  std::vector<Matrix> columns_;  ///< block column k: rows from its diagonal block downwards
};

}  // namespace tremie
