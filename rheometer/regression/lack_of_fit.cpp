#include "rheometer/regression/lack_of_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

/// Legendre polynomials over -1 to 1: a column a degree.
Eigen::MatrixXd smooth_basis(std::span<const double> x, Eigen::Index columns) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd basis(n, columns);
  const double span = x.back() - x.front();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u =
        span > 0.0
            ? 2.0 * std::log1p(30.0 * (x[static_cast<std::size_t>(i)] - x.front()) / span) / std::log(31.0) -
                  1.0
            : 0.0;
    double before = 1.0, now = u;
    basis(i, 0) = 1.0;
    for (Eigen::Index k = 1; k < columns; ++k) {
      basis(i, k) = now;
      const auto d = static_cast<double>(k);
      const double next = ((2.0 * d + 1.0) * u * now - d * before) / (d + 1.0);
      before = now;
      now = next;
    }
  }
  return basis;
}

}  // namespace

double effective_number(double n, double correlation) {
  const double rho = std::clamp(correlation, 0.0, 0.98);
  return n * (1.0 - rho) / (1.0 + rho);
}

double corrected_akaike(double mean_square, double n, int parameters) {
  const double k = parameters + 1.0;
  if (n <= k + 1.0) return std::numeric_limits<double>::infinity();
  return n * std::log(std::max(mean_square, 1e-18)) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
}

LackOfFit lack_of_fit(std::span<const double> x, std::span<const double> residual) {
  LackOfFit result;
  const auto n = static_cast<Eigen::Index>(residual.size());
  if (n < 8) return result;
  const Eigen::Index columns = std::min<Eigen::Index>(6, n / 3);
  const Eigen::MatrixXd basis = smooth_basis(x, columns);
  const Eigen::Map<const Eigen::VectorXd> r(residual.data(), n);
  const Eigen::VectorXd smooth = basis * basis.colPivHouseholderQr().solve(r);
  const Eigen::VectorXd left = r - smooth;
  const auto count = static_cast<double>(n), q = static_cast<double>(columns);
  result.systematic = std::sqrt(smooth.squaredNorm() / count);
  result.noise = std::sqrt(left.squaredNorm() / (count - q));
  std::vector<double> second;
  for (std::size_t i = 2; i < residual.size(); ++i)
    second.push_back(residual[i] - 2.0 * residual[i - 1] + residual[i - 2]);
  result.roughness_noise = robust_deviation(second) / std::sqrt(6.0);
  result.correlation = successive_correlation({left.begin(), left.end()});
  // the smooth curve takes part of the correlation with it: about (1 + 3 rho + q)/n of it (Marriott and Pope 1954)
  const double rho = std::clamp(result.correlation + (1.0 + 3.0 * result.correlation + q) / count, 0.0, 0.95);
  const double inflation = (1.0 + rho) / (1.0 - rho), independent = count / inflation;
  const double mean_square = std::max(left.squaredNorm() / (count - q), 1e-18);
  const double f = smooth.squaredNorm() / q / (mean_square * inflation);
  result.probability = fisher_tail(f, q, std::max(2.0, independent - q));
  return result;
}

}  // namespace tremie
