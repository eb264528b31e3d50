#pragma once

// Preconditioned conjugate gradients whose bits do not depend on the threads.

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace tremie {

/// Sum of products in fixed blocks.
inline double block_dot(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  constexpr Eigen::Index block = 2048;
  const Eigen::Index n = (a.size() + block - 1) / block;
  std::vector<double> part(static_cast<std::size_t>(n));
#pragma omp parallel for schedule(static)
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index size = std::min(block, a.size() - i * block);
    part[static_cast<std::size_t>(i)] = a.segment(i * block, size).dot(b.segment(i * block, size));
  }
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
template <class Multiply, class Precondition>
double conjugate_gradients(Multiply multiply, Precondition precondition, const SolveGoal& goal,
                           Eigen::VectorXd& R, Eigen::VectorXd& x) {
  const Eigen::Index n = R.size();
  Eigen::VectorXd z(n), Ap(n);
  x.setZero(n);
  precondition(R, z);
  double rz = block_dot(R, z);
  const double enough = std::max(goal.enough, goal.reduction * goal.reduction * rz);
  Eigen::VectorXd p = z;
  for (int i = 0; rz > enough && i < goal.most; ++i) {
    multiply(p, Ap);
    const double alpha = rz / block_dot(p, Ap);
#pragma omp parallel for schedule(static)
    for (Eigen::Index j = 0; j < n; ++j) {
      x[j] += alpha * p[j];
      R[j] -= alpha * Ap[j];
    }
    precondition(R, z);
    // Polak and Ribiere's beta, (z, r_new - r_old) / rz, forgives a preconditioner that is rounded.
    const double beta = -alpha * block_dot(Ap, z) / rz;
    rz = block_dot(R, z);
#pragma omp parallel for schedule(static)
    for (Eigen::Index j = 0; j < n; ++j) p[j] = z[j] + beta * p[j];
  }
  return rz;
}

}  // namespace tremie
