#pragma once

// Preconditioned conjugate gradients whose bits do not depend on the threads.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tremie {

inline constexpr Eigen::Index dot_block = 1024;

/// Calls use(begin, size) for fixed blocks of n entries, on all threads.
template <class Use>
void for_each_block(Eigen::Index n, Use use) {
#pragma omp parallel for schedule(static)
  for (Eigen::Index i = 0; i < n; i += dot_block) use(i, std::min(dot_block, n - i));
}

/// Sums of products with z, each in fixed blocks.
template <class Vector, class... Others>
std::array<double, sizeof...(Others)> block_dots(const Vector& z, const Others&... with) {
  using Sums = std::array<double, sizeof...(Others)>;
  std::vector<Sums> part(static_cast<std::size_t>((z.size() + dot_block - 1) / dot_block));
  for_each_block(z.size(), [&](Eigen::Index i, Eigen::Index size) {
    part[i / dot_block] = {static_cast<double>(with.segment(i, size).dot(z.segment(i, size)))...};
  });
  Sums sum{};
  for (const Sums& p : part)
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += p[k];
  return sum;
}

struct PcgTolerances {
  double reduction = 1e-6;  ///< of the residual's energy norm, the root of (r, P^-1 r)
  double enough = 0.0;      ///< a (r, P^-1 r) that needs no more work
  int most = 500;           ///< iterations
};

/// Solves A x = R from x = 0 and leaves the residual in R; returns the size of the last (r, P^-1 r).
/// multiply(x, out) and precondition(r, z) apply A and P^-1, both symmetric and positive definite; it ends
/// where rounding makes them seem not to be.
template <class Vector, class Multiply, class Precondition>
double conjugate_gradients(Multiply multiply, Precondition precondition, const PcgTolerances& goal, Vector& R,
                           Vector& x) {
  using Scalar = typename Vector::Scalar;
  const Eigen::Index n = R.size();
  Vector z(n), Ap(n), p(n);
  x.resize(n);
  precondition(R, z);
  double rz = block_dots(z, R)[0];
  const double enough = std::max(goal.enough, goal.reduction * goal.reduction * rz);
  for_each_block(n, [&](Eigen::Index j, Eigen::Index size) {
    x.segment(j, size).setZero();
    p.segment(j, size) = z.segment(j, size);
  });
  for (int i = 0; rz > enough && i < goal.most; ++i) {
    multiply(p, Ap);
    const double pAp = block_dots(Ap, p)[0];
    if (!(pAp > 0.0)) break;
    const double alpha = rz / pAp;
    const auto step = static_cast<Scalar>(alpha);
    for_each_block(n, [&](Eigen::Index j, Eigen::Index size) {
      x.segment(j, size) += step * p.segment(j, size);
      R.segment(j, size) -= step * Ap.segment(j, size);
    });
    precondition(R, z);
    // Polak and Ribiere's beta, (z, r_new - r_old) / rz, forgives a preconditioner that is rounded.
    const auto [Ap_z, R_z] = block_dots(z, Ap, R);
    const double beta = -alpha * Ap_z / rz;
    rz = R_z;
    const auto again = static_cast<Scalar>(beta);
    for_each_block(n, [&](Eigen::Index j, Eigen::Index size) {
      p.segment(j, size) = z.segment(j, size) + again * p.segment(j, size);
    });
  }
  return std::abs(rz);
}

}  // namespace tremie
