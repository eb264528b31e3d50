#pragma once

// Cholesky factorisation of a symmetric positive definite band matrix from both of its ends at once.
//
// Unknowns are eliminated from the first and from the last towards a dense block in the middle that is as
// wide as the band: no more operations than from one end to the other, and two threads share them. What is
// done does not depend on the threads, nor do the bits.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

namespace tremie {

template <class Scalar>
class TwoEndedCholesky {
 public:
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  static constexpr int block = 32;

  /// Makes room for n unknowns coupled over at most `bandwidth` rows below the diagonal; all entries zero.
  void reset(int n, int bandwidth) {
    n_ = n;
    below_ = (bandwidth + block - 1) / block * block;
    const int blocks = std::max(0, n - below_) / block;
#pragma omp parallel for schedule(static, 1)
    for (int e = 0; e < 2; ++e) ends_[e].reset(e == 0 ? blocks - blocks / 2 : blocks / 2, below_);
    middle_.setZero(n - ends_[0].size() - ends_[1].size(), n - ends_[0].size() - ends_[1].size());
  }
  /// Adds to the entry (i, j), i >= j. Threads may add to different entries.
  void add(int i, int j, Scalar value) {
    const int first = ends_[0].size(), last = n_ - ends_[1].size();
    if (j < first)
      ends_[0].add(i, j, value);
    else if (i >= last)
      ends_[1].add(n_ - 1 - j, n_ - 1 - i, value);
    else
      middle_(i - first, j - first) += value;
  }

  /// In place; false where the matrix is not positive definite.
  bool factorise() {
    std::array<bool, 2> good{};
    bool middle_good = false;
#pragma omp parallel
    {
#pragma omp for schedule(static, 1)
      for (int e = 0; e < 2; ++e) good[static_cast<std::size_t>(e)] = ends_[e].factorise();
#pragma omp single
      middle_good = factorise_middle();
    }
    return good[0] && good[1] && middle_good;
  }

  /// Solves for x in place. To be called by all threads of a parallel region.
  void solve_in_region(Vector& x) {
#pragma omp for schedule(static, 1)
    for (int e = 0; e < 2; ++e) {
      End& end = ends_[e];
      for (int i = 0; i < end.size(); ++i) end.y[i] = x[e == 0 ? i : n_ - 1 - i];
      end.forward();
    }
#pragma omp single
    solve_middle(x);
#pragma omp for schedule(static, 1)
    for (int e = 0; e < 2; ++e) {
      End& end = ends_[e];
      const int size = end.size(), reach = end.empty() ? 0 : below_;
      for (int i = 0; i < reach; ++i) end.y[size + i] = x[e == 0 ? size + i : n_ - 1 - size - i];
      end.backward();
      for (int i = 0; i < size; ++i) x[e == 0 ? i : n_ - 1 - i] = end.y[i];
    }
  }

 private:
  /// The block columns that are eliminated from one end, numbered from there.
  struct End {
    std::vector<Matrix> columns;  ///< rows from the diagonal block downwards; that block's factor is inverted
    Matrix rest;                  ///< what the elimination leaves to the middle's nearest unknowns
    Vector y;
    int below = 0;

    int size() const { return static_cast<int>(columns.size()) * block; }
    bool empty() const { return columns.empty(); }
    void reset(int blocks, int reach) {
      below = reach;
      columns.resize(static_cast<std::size_t>(blocks));
      for (Matrix& c : columns) c.setZero(block + below, block);
      rest.setZero(blocks == 0 ? 0 : below, blocks == 0 ? 0 : below);
      y.setZero(size() + below);
    }
    void add(int i, int j, Scalar value) {
      columns[static_cast<std::size_t>(j / block)](i - j / block * block, j % block) += value;
    }
    bool factorise() {
      const int n = static_cast<int>(columns.size());
      for (int k = 0; k < n; ++k) {
        Matrix& column = columns[static_cast<std::size_t>(k)];
        auto diagonal = column.template topRows<block>();
        const Eigen::LLT<Matrix> llt(diagonal);
        if (llt.info() != Eigen::Success) return false;
        diagonal.setIdentity();
        llt.matrixL().solveInPlace(diagonal);
        auto panel = column.bottomRows(below);
        panel = (panel * diagonal.transpose()).eval();
        for (int j = 0; j * block < below; ++j) {
          const auto target =
              panel.bottomRows(below - j * block) * panel.middleRows(j * block, block).transpose();
          if (k + 1 + j < n) {
            columns[static_cast<std::size_t>(k + 1 + j)].topRows(below - j * block).noalias() -= target;
          } else {
            const int at = (k + 1 + j - n) * block;
            rest.block(at, at, below - j * block, block).noalias() -= target;
          }
        }
      }
      return true;
    }
    void forward() {
      y.tail(below).setZero();
      for (int k = 0; k < static_cast<int>(columns.size()); ++k) {
        const Matrix& column = columns[static_cast<std::size_t>(k)];
        const Eigen::Matrix<Scalar, block, 1> part =
            column.template topRows<block>() * y.template segment<block>(k * block);
        y.template segment<block>(k * block) = part;
        y.segment((k + 1) * block, below).noalias() -= column.bottomRows(below) * part;
      }
    }
    void backward() {
      for (int k = static_cast<int>(columns.size()) - 1; k >= 0; --k) {
        const Matrix& column = columns[static_cast<std::size_t>(k)];
        Eigen::Matrix<Scalar, block, 1> part = y.template segment<block>(k * block);
        part.noalias() -= column.bottomRows(below).transpose() * y.segment((k + 1) * block, below);
        y.template segment<block>(k * block) = column.template topRows<block>().transpose() * part;
      }
    }
  };

  bool factorise_middle() {
    const Eigen::Index m = middle_.rows();
    for (int e = 0; e < 2; ++e) {
      const Matrix& rest = ends_[e].rest;
      for (Eigen::Index j = 0; j < rest.cols(); ++j)
        for (Eigen::Index i = j; i < rest.rows(); ++i)
          e == 0 ? middle_(i, j) += rest(i, j) : middle_(m - 1 - j, m - 1 - i) += rest(i, j);
    }
    llt_.compute(middle_);
    return llt_.info() == Eigen::Success;
  }
  void solve_middle(Vector& x) {
    const int first = ends_[0].size(), m = static_cast<int>(middle_.rows());
    auto part = x.segment(first, m);
    if (!ends_[0].empty()) part.head(below_) += ends_[0].y.tail(below_);
    if (!ends_[1].empty()) part.tail(below_) += ends_[1].y.tail(below_).reverse();
    llt_.solveInPlace(part);
  }

  int n_ = 0, below_ = 0;
  std::array<End, 2> ends_;
  Matrix middle_;
  /// A factor from the start: what Eigen leaves unset in an empty one may not be copied.
  Eigen::LLT<Matrix> llt_{Matrix::Identity(1, 1)};
};

}  // namespace tremie
