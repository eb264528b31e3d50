#include "libmpm/linear/twisted_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace tremie {

namespace {

constexpr int block = TwistedCholesky::block;

int whole_blocks(int rows) { return (std::max(0, rows) + block - 1) / block * block; }

/// Rows below the diagonal block that so many block columns have, those that elimination fills included.
std::vector<int> column_heights(const std::vector<int>& first, int blocks) {
  const int n = static_cast<int>(first.size());
  std::vector<int> last(first.size(), 0);  // by column: the last row that begins there, if any
  for (int i = 0; i < n; ++i) last[first[i]] = i;
  std::vector<int> heights;
  int end = 0;  // of the rows that begin in the columns so far
  for (int k = 0; k < blocks; ++k) {
    for (int j = k * block; j < (k + 1) * block; ++j) end = std::max(end, last[j] + 1);
    heights.push_back(whole_blocks(end - (k + 1) * block));
  }
  return heights;
}
/// The same with rows and columns counted from the last.
std::vector<int> heights_from_the_last(const std::vector<int>& first, int blocks) {
  const int n = static_cast<int>(first.size());
  std::vector<int> heights;
  int begin = n;  // the first column of the rows so far
  for (int k = 0; k < blocks; ++k) {
    for (int i = n - 1 - k * block; i >= n - (k + 1) * block; --i) begin = std::min(begin, first[i]);
    heights.push_back(whole_blocks(n - (k + 1) * block - begin));
  }
  return heights;
}

}  // namespace

void TwistedCholesky::reset(const std::vector<int>& first) {
  n_ = static_cast<int>(first.size());
  int bandwidth = 0;
  for (int i = 0; i < n_; ++i) bandwidth = std::max(bandwidth, i - first[i]);
  below_ = whole_blocks(bandwidth);
  const int blocks = std::max(0, n_ - below_) / block;
#pragma omp parallel for schedule(static, 1)
  for (int e = 0; e < 2; ++e)
    e == 0 ? ends_[0].reset(column_heights(first, blocks - blocks / 2), below_)
           : ends_[1].reset(heights_from_the_last(first, blocks / 2), below_);
  middle_.setZero(n_ - ends_[0].size() - ends_[1].size(), n_ - ends_[0].size() - ends_[1].size());
}

bool TwistedCholesky::factorise() {
  std::array<bool, 2> good{};
  bool middle_good = false;
#pragma omp parallel
  {
#pragma omp for schedule(static, 1)
    for (int e = 0; e < 2; ++e) good[e] = ends_[e].factorise();
#pragma omp single
    middle_good = factorise_middle();
  }
  return good[0] && good[1] && middle_good;
}

void TwistedCholesky::solve_in_region(Eigen::VectorXf& x) {
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

void TwistedCholesky::End::reset(std::vector<int> heights, int reach) {
  below = reach;
  height = std::move(heights);
  columns.resize(height.size());
  for (Eigen::MatrixXf& c : columns) c.setZero(block + below, block);
  rest.setZero(empty() ? 0 : below, empty() ? 0 : below);
  y.setZero(size() + below);
}

/// Of the rows from j on that a product could have, those that it needs. Whole tiles of a matrix product:
/// then each entry is summed in the same order as without the rows left out.
int TwistedCholesky::End::rows_needed(int k, int j) const {
  constexpr int tile = 3 * 64 / static_cast<int>(sizeof(float));
  const int rows = std::max(0, height[k] - j);
  return std::min(below - j, (rows + tile - 1) / tile * tile);
}

bool TwistedCholesky::End::factorise() {
  const int n = static_cast<int>(columns.size());
  for (int k = 0; k < n; ++k) {
    Eigen::MatrixXf& column = columns[k];
    auto diagonal = column.topRows<block>();
    const Eigen::LLT<Eigen::MatrixXf> llt(diagonal);
    if (llt.info() != Eigen::Success) return false;
    diagonal.setIdentity();
    llt.matrixL().solveInPlace(diagonal);
    auto panel = column.middleRows(block, rows_needed(k, 0));
    panel = (panel * diagonal.transpose()).eval();
    for (int j = 0; j * block < height[k]; ++j) {
      const int rows = rows_needed(k, j * block);
      const auto target =
          column.middleRows((j + 1) * block, rows) * column.middleRows((j + 1) * block, block).transpose();
      if (k + 1 + j < n) {
        columns[k + 1 + j].topRows(rows).noalias() -= target;
      } else {
        const int at = (k + 1 + j - n) * block;
        rest.block(at, at, rows, block).noalias() -= target;
      }
    }
  }
  return true;
}

void TwistedCholesky::End::forward() {
  y.tail(below).setZero();
  for (int k = 0; k < static_cast<int>(columns.size()); ++k) {
    const Eigen::MatrixXf& column = columns[k];
    const Eigen::Matrix<float, block, 1> part = column.topRows<block>() * y.segment<block>(k * block);
    y.segment<block>(k * block) = part;
    const int rows = height[k];
    y.segment((k + 1) * block, rows).noalias() -= column.middleRows(block, rows) * part;
  }
}

void TwistedCholesky::End::backward() {
  for (int k = static_cast<int>(columns.size()) - 1; k >= 0; --k) {
    const Eigen::MatrixXf& column = columns[k];
    Eigen::Matrix<float, block, 1> part = y.segment<block>(k * block);
    const int rows = height[k];
    part.noalias() -= column.middleRows(block, rows).transpose() * y.segment((k + 1) * block, rows);
    y.segment<block>(k * block) = column.topRows<block>().transpose() * part;
  }
}

bool TwistedCholesky::factorise_middle() {
  const Eigen::Index m = middle_.rows();
  for (int e = 0; e < 2; ++e) {
    const Eigen::MatrixXf& rest = ends_[e].rest;
    for (Eigen::Index j = 0; j < rest.cols(); ++j)
      for (Eigen::Index i = j; i < rest.rows(); ++i)
        e == 0 ? middle_(i, j) += rest(i, j) : middle_(m - 1 - j, m - 1 - i) += rest(i, j);
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>> llt(middle_);  // in place
  return llt.info() == Eigen::Success;
}

void TwistedCholesky::solve_middle(Eigen::VectorXf& x) {
  const int first = ends_[0].size(), m = static_cast<int>(middle_.rows());
  auto part = x.segment(first, m);
  if (!ends_[0].empty()) part.head(below_) += ends_[0].y.tail(below_);
  if (!ends_[1].empty()) part.tail(below_) += ends_[1].y.tail(below_).reverse();
  middle_.triangularView<Eigen::Lower>().solveInPlace(part);
  middle_.triangularView<Eigen::Lower>().transpose().solveInPlace(part);
}

}  // namespace tremie
