// The factor of a band matrix from both of its ends: solutions of systems whose solution is known.

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "libmpm/linear/twisted_cholesky.hpp"

namespace tremie {
namespace {

/// A system with the solution 1, 2, ..., 9, 1, ...: what the envelope holds is random in [-1, 0], and the
/// diagonal d exceeds the row's other entries by one, so that the eigenvalues lie between 1 and 2 max(d) - 1.
struct System {
  Eigen::MatrixXd A;
  std::vector<int> first;

  explicit System(std::vector<int> envelope) : first(std::move(envelope)) {
    const auto n = static_cast<Eigen::Index>(first.size());
    A.setZero(n, n);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> entry(-1.0, 0.0);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = first[static_cast<std::size_t>(i)]; j < i; ++j) A(i, j) = A(j, i) = entry(random);
    for (Eigen::Index i = 0; i < n; ++i) A(i, i) = 1.0 - A.row(i).sum();
  }
  Eigen::VectorXf solution() const {
    Eigen::VectorXf x(A.rows());
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = static_cast<float>(1 + i % 9);
    return x;
  }
  /// What the factor makes of A times the solution with so many threads.
  Eigen::VectorXf solved(int threads) const {
    omp_set_num_threads(threads);
    TwistedCholesky factor;
    factor.reset(first);
    const int n = static_cast<int>(A.rows());
    for (int i = 0; i < n; ++i)
      for (int j = first[static_cast<std::size_t>(i)]; j <= i; ++j)
        factor.add(i, j, static_cast<float>(A(i, j)));
    EXPECT_TRUE(factor.factorise());
    Eigen::VectorXf x = (A * solution().cast<double>()).cast<float>();
#pragma omp parallel
    factor.solve_in_region(x);
    return x;
  }
  /// Single precision, 1.2e-7 of the largest entry, 9, times the condition number; tenfold for long sums.
  double tolerance() const { return 10.0 * 9.0 * 1.2e-7 * (2.0 * A.diagonal().maxCoeff() - 1.0); }
};

/// Rows coupled with the lines of cells next to them, of a body whose lines have so many cells.
std::vector<int> lines(const std::vector<int>& cells) {
  std::vector<int> first;
  int before = 0;  // where the line before begins
  for (int size : cells) {
    const int line = static_cast<int>(first.size());
    first.insert(first.end(), static_cast<std::size_t>(size), before);
    before = line;
  }
  return first;
}

void expect_solved(const System& system) {
  const Eigen::VectorXf one = system.solved(1), two = system.solved(2);
  EXPECT_LT((one - system.solution()).cwiseAbs().maxCoeff(), system.tolerance());
  EXPECT_EQ(one, two);  // the bits do not depend on the threads
}

TEST(TwistedCholesky, SolvesABandOfOneWidth) {
  std::vector<int> first;
  for (int i = 0; i < 700; ++i) first.push_back(std::max(0, i - 90));
  expect_solved(System(first));
}

TEST(TwistedCholesky, SolvesABandThatIsNarrowTowardsTheEndsOfARoundBody) {
  std::vector<int> cells;
  for (int i = -14; i <= 14; ++i) cells.push_back(2 + static_cast<int>(3.0 * std::sqrt(225.0 - i * i)));
  expect_solved(System(lines(cells)));
}

TEST(TwistedCholesky, SolvesPiecesThatDoNotTouch) {
  std::vector<int> first;
  for (int i = 0; i < 600; ++i) first.push_back(std::max(i / 150 * 150, i - 70));
  expect_solved(System(first));
}

TEST(TwistedCholesky, SolvesARowThatReachesFarBackAmongShortOnes) {
  std::vector<int> first;
  for (int i = 0; i < 500; ++i) first.push_back(std::max(0, i - 3));
  first[200] = 60, first[320] = 310, first[430] = 300;
  expect_solved(System(first));
}

TEST(TwistedCholesky, SolvesWhatIsSmallerThanItsBand) {
  expect_solved(System({0}));
  expect_solved(System({0, 0, 1, 0, 2}));
  expect_solved(System(std::vector<int>(130, 0)));
}

TEST(TwistedCholesky, SolvesWhatIsNotCoupledAtAll) {
  std::vector<int> first;
  for (int i = 0; i < 100; ++i) first.push_back(i);
  expect_solved(System(first));
}

TEST(TwistedCholesky, RefusesWhatIsNotPositiveDefinite) {
  for (int wrong : {3, 250, 497}) {  // at the first end, in the middle, at the last
    TwistedCholesky factor;
    std::vector<int> first;
    for (int i = 0; i < 500; ++i) first.push_back(std::max(0, i - 40));
    factor.reset(first);
    for (int i = 0; i < 500; ++i) factor.add(i, i, i == wrong ? -1.0f : 1.0f);
    EXPECT_FALSE(factor.factorise()) << wrong;
  }
}

}  // namespace
}  // namespace tremie
