#pragma once

// Cholesky factorisation of a symmetric positive definite band matrix from both of its ends at once.
//
// Unknowns are eliminated from the first and from the last towards a dense block in the middle that is as
// wide as the band: no more operations than from one end to the other, and two threads share them. What is
// done does not depend on the threads, nor do the bits. Where the band is narrower than at its widest, as it
// is towards the ends of a round body, the rows that stay zero are passed over.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace tremie {

template <class Scalar>
class TwistedCholesky {
 public:
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  static constexpr int block = 32;

  /// Allocates a row an entry of `first`, the first column that it is coupled with; all entries zero.
  void reset(const std::vector<int>& first) {
    n_ = static_cast<int>(first.size());
    int bandwidth = 0;
    for (int i = 0; i < n_; ++i) bandwidth = std::max(bandwidth, i - first[static_cast<std::size_t>(i)]);
    below_ = whole_blocks(bandwidth);
    const int blocks = std::max(0, n_ - below_) / block;
#pragma omp parallel for schedule(static, 1)
    for (int e = 0; e < 2; ++e)
      e == 0 ? ends_[0].reset(heights_from_the_first(first, blocks - blocks / 2), below_)
             : ends_[1].reset(heights_from_the_last(first, blocks / 2), below_);
    middle_.setZero(n_ - ends_[0].size() - ends_[1].size(), n_ - ends_[0].size() - ends_[1].size());
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
  static int whole_blocks(int rows) { return (std::max(0, rows) + block - 1) / block * block; }

  /// Rows below the diagonal block that so many block columns have, those that elimination fills included.
  static std::vector<int> heights_from_the_first(const std::vector<int>& first, int blocks) {
    const int n = static_cast<int>(first.size());
    std::vector<int> last(first.size(), 0);  // by column: the last row that begins there, if any
    for (int i = 0; i < n; ++i) last[static_cast<std::size_t>(first[static_cast<std::size_t>(i)])] = i;
    std::vector<int> heights;
    int end = 0;  // of the rows that begin in the columns so far
    for (int k = 0; k < blocks; ++k) {
      for (int j = k * block; j < (k + 1) * block; ++j)
        end = std::max(end, last[static_cast<std::size_t>(j)] + 1);
      heights.push_back(whole_blocks(end - (k + 1) * block));
    }
    return heights;
  }
  /// The same with rows and columns counted from the last.
  static std::vector<int> heights_from_the_last(const std::vector<int>& first, int blocks) {
    const int n = static_cast<int>(first.size());
    std::vector<int> heights;
    int begin = n;  // the first column of the rows so far
    for (int k = 0; k < blocks; ++k) {
      for (int i = n - 1 - k * block; i >= n - (k + 1) * block; --i)
        begin = std::min(begin, first[static_cast<std::size_t>(i)]);
      heights.push_back(whole_blocks(n - (k + 1) * block - begin));
    }
    return heights;
  }

  /// The block columns that are eliminated from one end, numbered from there.
  struct End {
    std::vector<Matrix> columns;  ///< rows from the diagonal block downwards; that block's factor is inverted
    std::vector<int> height;      ///< of each: the rows below its diagonal block that are not all zero
    Matrix rest;                  ///< what the elimination leaves to the middle's nearest unknowns
    Vector y;
    int below = 0;  ///< rows below a diagonal block

    int size() const { return static_cast<int>(columns.size()) * block; }
    bool empty() const { return columns.empty(); }
    void reset(std::vector<int> heights, int reach) {
      below = reach;
      height = std::move(heights);
      columns.resize(height.size());
      for (Matrix& c : columns) c.setZero(block + below, block);
      rest.setZero(empty() ? 0 : below, empty() ? 0 : below);
      y.setZero(size() + below);
    }
    void add(int i, int j, Scalar value) {
      columns[static_cast<std::size_t>(j / block)](i - j / block * block, j % block) += value;
    }
    /// Of the rows from j on that a product could have, those that it needs. Whole tiles of a matrix product:
    /// then each entry is summed in the same order as without the rows left out.
    int rows_needed(int k, int j) const {
      constexpr int tile = 3 * 64 / static_cast<int>(sizeof(Scalar));
      const int rows = std::max(0, height[static_cast<std::size_t>(k)] - j);
      return std::min(below - j, (rows + tile - 1) / tile * tile);
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
        auto panel = column.middleRows(block, rows_needed(k, 0));
        panel = (panel * diagonal.transpose()).eval();
        for (int j = 0; j * block < height[static_cast<std::size_t>(k)]; ++j) {
          const int rows = rows_needed(k, j * block);
          const auto target = column.middleRows((j + 1) * block, rows) *
                              column.middleRows((j + 1) * block, block).transpose();
          if (k + 1 + j < n) {
            columns[static_cast<std::size_t>(k + 1 + j)].topRows(rows).noalias() -= target;
          } else {
            const int at = (k + 1 + j - n) * block;
            rest.block(at, at, rows, block).noalias() -= target;
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
        const int rows = height[static_cast<std::size_t>(k)];
        y.segment((k + 1) * block, rows).noalias() -= column.middleRows(block, rows) * part;
      }
    }
    void backward() {
      for (int k = static_cast<int>(columns.size()) - 1; k >= 0; --k) {
        const Matrix& column = columns[static_cast<std::size_t>(k)];
        Eigen::Matrix<Scalar, block, 1> part = y.template segment<block>(k * block);
        const int rows = height[static_cast<std::size_t>(k)];
        part.noalias() -= column.middleRows(block, rows).transpose() * y.segment((k + 1) * block, rows);
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
