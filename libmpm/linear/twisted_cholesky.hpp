#pragma once

// Cholesky factorisation of a symmetric positive definite band matrix from both of its ends at once.
//
// Unknowns are eliminated from the first and from the last towards a dense block in the middle that is as
// wide as the band: no more operations than from one end to the other, and two threads share them. What is
// done does not depend on the threads, nor do the bits. Where the band is narrower than at its widest, as it
// is towards the ends of a round body, the rows that stay zero are passed over.

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tremie {

class TwistedCholesky {
 public:
  static constexpr int block = 32;

  /// Allocates a row an entry of `first`, the first column that it is coupled with; all entries zero.
  void reset(const std::vector<int>& first);
  /// Adds to the entry (i, j), i >= j. Threads may add to different entries.
  void add(int i, int j, float value) {
    const int first = ends_[0].size(), last = n_ - ends_[1].size();
    if (j < first)
      ends_[0].add(i, j, value);
    else if (i >= last)
      ends_[1].add(n_ - 1 - j, n_ - 1 - i, value);
    else
      middle_(i - first, j - first) += value;
  }
  /// In place; false where the matrix is not positive definite.
  bool factorise();
  /// Solves for x in place. To be called by all threads of a parallel region.
  void solve_in_region(Eigen::VectorXf& x);

 private:
  /// The block columns that are eliminated from one end, numbered from there.
  struct End {
    std::vector<Eigen::MatrixXf>
        columns;              ///< rows from the diagonal block downwards; that block's factor is inverted
    std::vector<int> height;  ///< of each: the rows below its diagonal block that are not all zero
    Eigen::MatrixXf rest;     ///< what the elimination leaves to the middle's nearest unknowns
    Eigen::VectorXf y;
    int below = 0;  ///< rows below a diagonal block

    int size() const { return static_cast<int>(columns.size()) * block; }
    bool empty() const { return columns.empty(); }
    void reset(std::vector<int> heights, int reach);
    void add(int i, int j, float value) { columns[j / block](i - j / block * block, j % block) += value; }
    int rows_needed(int k, int j) const;
    bool factorise();
    void forward();
    void backward();
  };

  bool factorise_middle();
  void solve_middle(Eigen::VectorXf& x);

  int n_ = 0, below_ = 0;
  std::array<End, 2> ends_;
  Eigen::MatrixXf middle_;  ///< once factorised: its factor, in the lower half
};

}  // namespace tremie
