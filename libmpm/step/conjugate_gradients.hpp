#pragma once

// Preconditioned conjugate gradients whose bits do not depend on the threads.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace tremie {

/// Calls use(begin, size) for fixed blocks of n entries, on all threads.
template <class Use>
void for_each_block(Eigen::Index n, Use use) {
  constexpr Eigen::Index block = 1024;
#pragma omp parallel for schedule(static)
  for (Eigen::Index i = 0; i < n; i += block) use(i, std::min(block, n - i));
}

/// Sum of products in fixed blocks.
template <class Vector>
double block_dot(const Vector& a, const Vector& b) {
  std::vector<double> part(static_cast<std::size_t>(a.size() / 512 + 1), 0.0);
  for_each_block(a.size(), [&](Eigen::Index i, Eigen::Index size) {
    part[static_cast<std::size_t>(i / 512)] = static_cast<double>(a.segment(i, size).dot(b.segment(i, size)));
  });
  double sum = 0.0;
  for (double p : part) sum += p;
  return sum;
}

struct SolveGoal {
  double reduction = 1e-6;  ///< of the residual's energy norm, the root of (r, P^-1 r)
  double enough = 0.0;      ///< a (r, P^-1 r) that needs no more work
  int most = 500;           ///< iterations
};

/// Solves A x = R from x = 0 and leaves the residual in R; returns the last (r, P^-1 r). multiply(x, out) and
/// precondition(r, z) apply A and P^-1, both symmetric and positive definite.
template <class Vector, class Multiply, class Precondition>
double conjugate_gradients(Multiply multiply, Precondition precondition, const SolveGoal& goal, Vector& R,
                           Vector& x) {
  using Scalar = typename Vector::Scalar;
  const Eigen::Index n = R.size();
  Vector z(n), Ap(n);
  x.setZero(n);
  precondition(R, z);
  double rz = block_dot(R, z);
  const double enough = std::max(goal.enough, goal.reduction * goal.reduction * rz);
  Vector p = z;
  for (int i = 0; rz > enough && i < goal.most; ++i) {
    multiply(p, Ap);
    const double alpha = rz / block_dot(p, Ap);
    const auto step = static_cast<Scalar>(alpha);
    for_each_block(n, [&](Eigen::Index j, Eigen::Index size) {
      x.segment(j, size) += step * p.segment(j, size);
      R.segment(j, size) -= step * Ap.segment(j, size);
    });
    precondition(R, z);
    // Polak and Ribiere's beta, (z, r_new - r_old) / rz, forgives a preconditioner that is rounded.
    const double beta = -alpha * block_dot(Ap, z) / rz;
    rz = block_dot(R, z);
    const auto again = static_cast<Scalar>(beta);
    for_each_block(n, [&](Eigen::Index j, Eigen::Index size) {
      p.segment(j, size) = z.segment(j, size) + again * p.segment(j, size);
    });
  }
  return rz;
}

}  // namespace tremie
