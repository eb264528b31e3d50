#include "rheometer/regression/random_effects.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

/// r^T V^-1 r of what the generalised least squares leave of y, with a variance between the values added to V.
double generalised_squares(const Eigen::MatrixX2d& A, const Eigen::VectorXd& y, Eigen::MatrixXd V,
                           double between) {
  V.diagonal().array() += between;
  const Eigen::LDLT<Eigen::MatrixXd> factor(V);
  const Eigen::Matrix2d normal = A.transpose() * factor.solve(A);
  const Eigen::VectorXd left = y - A * normal.inverse() * (A.transpose() * factor.solve(y));
  return left.dot(factor.solve(left));
}

}  // namespace

LineOfEstimates line_of_estimates(const std::vector<double>& x, const std::vector<double>& y,
                                  const std::vector<double>& covariance, double degrees) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixX2d A(n, 2);
  A.col(0).setOnes();
  A.col(1) = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
  const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(y.data(), n);
  Eigen::MatrixXd V = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), n, n);
  V.diagonal() *= 1.0 + 1e-9;
  V.diagonal().array() += 1e-14;
  LineOfEstimates result;
  double t = student_quantile(0.975, std::max(1.0, degrees));
  const auto free = static_cast<double>(n - 2);
  const auto squares = [&](double between) { return generalised_squares(A, values, V, between); };
  if (n > 2) result.chance = cdf(complement(boost::math::chi_squared(free), std::max(0.0, squares(0.0))));
  if (result.chance < 0.05) {
    double low = 0.0, high = 1e-12;
    while (squares(high) > free && high < 1e6) high *= 4.0;
    for (int i = 0; i < 100; ++i) (squares(0.5 * (low + high)) > free ? low : high) = 0.5 * (low + high);
    V.diagonal().array() += high;
    result.between = std::sqrt(high);
    t = student_quantile(0.975, free);
  }
  // weights by the variances alone: with the covariances the line may leave the range of its values
  const Eigen::VectorXd weight = V.diagonal().cwiseInverse();
  const Eigen::Matrix2d normal = A.transpose() * weight.asDiagonal() * A;
  const Eigen::Matrix2Xd map = normal.inverse() * A.transpose() * weight.asDiagonal();
  const Eigen::Vector2d at = map * values;
  const Eigen::Matrix2d of_line = map * V * map.transpose();
  result.intercept = at(0), result.slope = at(1);
  result.half_of_intercept = t * std::sqrt(of_line(0, 0));
  result.half_of_slope = t * std::sqrt(of_line(1, 1));
  return result;
}

}  // namespace tremie
