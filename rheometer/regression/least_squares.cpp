#include "rheometer/regression/least_squares.hpp"

#include <ceres/cost_function.h>
#include <ceres/covariance.h>
#include <ceres/crs_matrix.h>
#include <ceres/evaluation_callback.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

// Relative residuals below this are the rounding of a record, not its scatter.
constexpr double resolution = 1e-9;

/// Runs the model once for each new point, for all readings: a reading alone cannot be computed any cheaper.
struct Evaluation : ceres::EvaluationCallback {
  const LeastSquaresProblem& problem;
  std::vector<double>& parameters;
  std::vector<double> at, fitted, jacobian;
  bool valid = false;

  Evaluation(const LeastSquaresProblem& p, std::vector<double>& x) : problem(p), parameters(x) {}

  void PrepareForEvaluation(bool evaluate_jacobians, bool) override {
    const std::size_t entries = problem.observed.size() * parameters.size();
    if (valid && at == parameters && (jacobian.size() == entries || !evaluate_jacobians)) return;
    fitted.resize(problem.observed.size());
    jacobian.resize(evaluate_jacobians ? entries : 0);
    at = parameters;
    const auto finite = [](const std::vector<double>& v) {
      return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
    };
    valid = problem.model(parameters, fitted, jacobian) && finite(fitted) && finite(jacobian);
  }
};

/// (observed - fitted) sqrt(count)/size of one reading, looked up in the evaluation.
class Reading : public ceres::CostFunction {
 public:
  Reading(const Evaluation& evaluation, std::size_t index, double weight)
      : evaluation_(evaluation), index_(index), weight_(weight) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(evaluation.parameters.size()));
  }

  bool Evaluate(const double* const*, double* residuals, double** jacobians) const override {
    if (!evaluation_.valid) return false;
    residuals[0] = weight_ * (evaluation_.fitted[index_] - evaluation_.problem.observed[index_]);
    if (jacobians && jacobians[0]) {
      const std::size_t n = evaluation_.parameters.size();
      for (std::size_t k = 0; k < n; ++k) jacobians[0][k] = weight_ * evaluation_.jacobian[index_ * n + k];
    }
    return true;
  }

 private:
  const Evaluation& evaluation_;
  std::size_t index_;
  double weight_;
};

/// One pass: the readings with use[i], each divided by size[i]; loss_scale 0: no loss function.
struct Pass {
  std::vector<double> parameters;
  Matrix jacobian;  // weighted, readings used x parameters
  Vector residual;  // weighted
  std::vector<char> told;
  Matrix covariance;  // (J^T J)^-1 over the parameters that are told, 0 for the others
};

/// Parameters whose columns of the Jacobian are no combination of the others'.
std::vector<char> told_apart(const Matrix& jacobian) {
  const auto n = static_cast<std::size_t>(jacobian.cols());
  if (jacobian.rows() < jacobian.cols()) return std::vector<char>(n, 0);
  std::vector<char> told(n, 1);
  Eigen::MatrixXd scaled = jacobian;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k) {
    const double norm = scaled.col(k).norm();
    if (norm > 0.0 && std::isfinite(norm)) scaled.col(k) /= norm;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
  for (Eigen::Index i = 0; i < svd.singularValues().size(); ++i) {
    if (svd.singularValues()(i) > 1e-6 * svd.singularValues()(0)) continue;
    for (std::size_t k = 0; k < n; ++k)
      if (std::abs(svd.matrixV()(static_cast<Eigen::Index>(k), i)) > 1e-3) told[k] = 0;
  }
  return told;
}

Matrix inverse_normal_matrix(ceres::Problem& problem, std::vector<double>& parameters) {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.min_reciprocal_condition_number = 1e-20;  // told_apart has judged already, scaled
  ceres::Covariance covariance(options);
  const std::vector<std::pair<const double*, const double*>> blocks{{parameters.data(), parameters.data()}};
  const auto n = static_cast<Eigen::Index>(parameters.size());
  Matrix result(n, n);
  if (!covariance.Compute(blocks, &problem) ||
      !covariance.GetCovarianceBlock(parameters.data(), parameters.data(), result.data()))
    return {};
  return result;
}

/// (J^T J)^-1 with the columns that are not told left out.
Matrix inverse_over_told(const Matrix& jacobian, const std::vector<char>& told) {
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < told.size(); ++k)
    if (told[k]) kept.push_back(static_cast<Eigen::Index>(k));
  Matrix result = Matrix::Zero(jacobian.cols(), jacobian.cols());
  if (kept.empty()) return result;
  const Eigen::MatrixXd part = jacobian(Eigen::all, kept);
  const Eigen::MatrixXd normal = part.transpose() * part;
  const Eigen::MatrixXd inverse = normal.inverse();
  result(kept, kept) = inverse;
  return result;
}

Pass minimise(const LeastSquaresProblem& p, std::vector<double> start, const std::vector<double>& size,
              const std::vector<char>& use, double loss_scale, const LeastSquaresOptions& wanted) {
  Pass pass;
  pass.parameters = std::move(start);
  Evaluation evaluation(p, pass.parameters);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &evaluation;
  ceres::Problem problem(problem_options);
  double* x = pass.parameters.data();
  for (std::size_t i = 0; i < p.observed.size(); ++i)
    if (use[i])
      problem.AddResidualBlock(new Reading(evaluation, i, std::sqrt(p.count[i]) / size[i]),
                               loss_scale > 0.0 ? new ceres::CauchyLoss(loss_scale) : nullptr, x);
  for (std::size_t k = 0; k < pass.parameters.size(); ++k) {
    problem.SetParameterLowerBound(x, static_cast<int>(k), p.lower[k]);
    problem.SetParameterUpperBound(x, static_cast<int>(k), p.upper[k]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = wanted.max_iterations;
  options.function_tolerance = 0.01 * wanted.parameter_tolerance;
  options.parameter_tolerance = wanted.parameter_tolerance;
  options.gradient_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE)
    throw std::runtime_error("the fit failed: " + summary.message);

  ceres::Problem::EvaluateOptions plain;
  plain.apply_loss_function = false;
  ceres::CRSMatrix sparse;
  std::vector<double> residuals;
  double cost = 0.0;
  problem.Evaluate(plain, &cost, &residuals, nullptr, &sparse);
  pass.residual = Eigen::Map<Vector>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
  // every row of the Jacobian is full, so its values lie as a dense matrix does
  pass.jacobian = Eigen::Map<Matrix>(sparse.values.data(), sparse.num_rows, sparse.num_cols);
  pass.told = told_apart(pass.jacobian);
  if (std::all_of(pass.told.begin(), pass.told.end(), [](char t) { return t != 0; }))
    pass.covariance = inverse_normal_matrix(problem, pass.parameters);
  if (pass.covariance.size() == 0) pass.covariance = inverse_over_told(pass.jacobian, pass.told);
  return pass;
}

/// Indices of the outliers among few readings: Rosner (1983), the largest Studentised residual taken out one
/// after another, family level 1 %. Works on the linearised fit, so that no refit is needed.
std::vector<std::size_t> extreme_deviates(const Pass& pass) {
  const Eigen::Index n = pass.residual.size(), p = pass.jacobian.cols();
  const Eigen::Index most = std::min<Eigen::Index>(n / 4, n - p - 2);
  std::vector<std::size_t> removed;
  std::vector<char> in(static_cast<std::size_t>(n), 1);
  Eigen::Index found = 0;
  for (Eigen::Index i = 1; i <= most; ++i) {
    Matrix normal = Matrix::Zero(p, p);
    Vector right = Vector::Zero(p);
    for (Eigen::Index k = 0; k < n; ++k)
      if (in[static_cast<std::size_t>(k)]) {
        normal += pass.jacobian.row(k).transpose() * pass.jacobian.row(k);
        right += pass.jacobian.row(k).transpose() * pass.residual(k);
      }
    const Matrix inverse = normal.inverse();
    const Vector residual = pass.residual - pass.jacobian * (inverse * right);
    double square = 0.0, worst = 0.0;
    for (Eigen::Index k = 0; k < n; ++k)
      if (in[static_cast<std::size_t>(k)]) square += residual(k) * residual(k);
    const double left = static_cast<double>(n - i + 1), degrees = left - static_cast<double>(p);
    const double scatter = std::max(std::sqrt(square / degrees), resolution);
    Eigen::Index at = 0;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (!in[static_cast<std::size_t>(k)]) continue;
      const double leverage = (pass.jacobian.row(k) * inverse * pass.jacobian.row(k).transpose())(0);
      const double deviate = std::abs(residual(k)) / (scatter * std::sqrt(std::max(1e-6, 1.0 - leverage)));
      if (deviate > worst) {
        worst = deviate;
        at = k;
      }
    }
    in[static_cast<std::size_t>(at)] = 0;
    removed.push_back(static_cast<std::size_t>(at));
    const double t = student_quantile(1.0 - 0.005 / left, degrees - 1.0);
    if (worst > t * std::sqrt(degrees / (degrees - 1.0 + t * t))) found = i;
  }
  removed.resize(static_cast<std::size_t>(found));
  return removed;
}

std::vector<std::size_t> outliers(const Pass& robust) {
  const Eigen::Index n = robust.residual.size();
  if (n < 50) {
    const bool all = std::all_of(robust.told.begin(), robust.told.end(), [](char t) { return t != 0; });
    return all ? extreme_deviates(robust) : std::vector<std::size_t>{};
  }
  const std::vector<double> residual(robust.residual.begin(), robust.residual.end());
  const double scatter = std::max(robust_deviation(residual), resolution);
  const double cut = student_quantile(1.0 - 0.0025 / static_cast<double>(n), 1e6) * scatter;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < residual.size(); ++i)
    if (std::abs(residual[i]) > cut) found.push_back(i);
  return found;
}

/// Readings in time order: three neighbours or more that miss on the same side, or two at the end, are a part of the
/// curve that the model does not describe, and so is the first, the peak. They are no outliers, and stay.
std::vector<std::size_t> without_runs(const std::vector<std::size_t>& found, const Pass& robust) {
  const auto last = static_cast<std::size_t>(robust.residual.size()) - 1;
  std::vector<std::size_t> kept;
  for (std::size_t from = 0, to = 0; from < found.size(); from = to) {
    const auto high = [&](std::size_t k) {
      return robust.residual(static_cast<Eigen::Index>(found[k])) > 0.0;
    };
    for (to = from + 1; to < found.size() && found[to] == found[to - 1] + 1 && high(to) == high(from);) ++to;
    if (found[from] != 0 && to - from < (found[to - 1] == last ? 2u : 3u))
      for (std::size_t k = from; k < to; ++k) kept.push_back(found[k]);
  }
  return kept;
}

/// Covariance of the parameters from (J^T J)^-1 and the residuals. With many readings it is the sandwich
/// (HC3), which does not believe that the error is in proportion to the reading; with few, that assumption
/// has to stand.
Matrix parameter_covariance(const Pass& pass, double variance) {
  if (pass.residual.size() < 50) return pass.covariance * variance;
  Matrix meat = Matrix::Zero(pass.covariance.rows(), pass.covariance.cols());
  for (Eigen::Index i = 0; i < pass.residual.size(); ++i) {
    const auto row = pass.jacobian.row(i);
    const double leverage = (row * pass.covariance * row.transpose())(0);
    const double r = pass.residual(i) / std::max(1e-6, 1.0 - leverage);
    meat += r * r * row.transpose() * row;
  }
  return pass.covariance * meat * pass.covariance;
}

/// Residuals, each in units of one reading, in the order in which they were taken; outliers left out.
std::vector<double> residuals_as_taken(const LeastSquaresProblem& p, const LeastSquaresOptions& options,
                                       const LeastSquaresFit& fit) {
  std::vector<double> residual;
  for (std::size_t k = 0; k < fit.residual.size(); ++k) {
    const std::size_t i = options.taken.empty() ? k : options.taken[k];
    if (!fit.outlier[i]) residual.push_back(std::sqrt(p.count[i]) * fit.residual[i]);
  }
  return residual;
}

/// By how much correlated residuals widen the covariance; takes their degrees of freedom off. 1 where the order of the
/// readings is not known.
double widened_by_correlation(const LeastSquaresOptions& options, LeastSquaresFit& fit) {
  const auto p = static_cast<double>(fit.parameters.size());
  const double n = fit.degrees_of_freedom + p;
  fit.independent = n;
  if (!options.readings_in_time_order && options.taken.empty()) return 1.0;
  const CorrelatedNoise noise = correlated_noise(fit.correlation, n, p);
  if (noise.inflation == 1.0) return 1.0;
  fit.independent = noise.independent;
  fit.degrees_of_freedom = noise.independent - p;
  // each parameter takes so many readings' share of the noise with it, so that the residuals read low
  return noise.inflation * (n - p) / (n - p * noise.inflation);
}

}  // namespace

LeastSquaresFit fit_least_squares(const LeastSquaresProblem& p, const LeastSquaresOptions& options) {
  const std::size_t n = p.observed.size();
  LeastSquaresFit fit;
  fit.fitted.resize(n);
  fit.residual.resize(n);
  fit.outlier.assign(n, 0);
  std::vector<char> use(n, 1);
  if (!p.model(p.start, fit.fitted, {}))
    throw std::runtime_error("the model has no value at the start of the fit");

  // Sizes are fitted values, never the readings themselves: a reading that is too small would weigh too much.
  const auto residuals = [&](const std::vector<double>& fitted) {
    std::vector<double> r;
    for (std::size_t i = 0; i < n; ++i)
      r.push_back(std::sqrt(p.count[i]) * (p.observed[i] - fitted[i]) / fitted[i]);
    return r;
  };
  LeastSquaresOptions rough = options;  // the robust passes only have to tell which readings belong
  rough.parameter_tolerance = std::max(options.parameter_tolerance, 1e-3);
  const std::vector<double> same_size(n, median(p.observed));
  Pass robust = minimise(p, p.start, same_size, use, 0.1, rough);
  for (int round = 0; round < 2; ++round) {
    p.model(robust.parameters, fit.fitted, {});
    const double scale = std::max(2.0 * robust_deviation(residuals(fit.fitted)), resolution);
    robust = minimise(p, robust.parameters, fit.fitted, use, scale, rough);
  }
  std::vector<std::size_t> found = options.find_outliers ? outliers(robust) : std::vector<std::size_t>{};
  std::sort(found.begin(), found.end());
  if (options.readings_in_time_order) found = without_runs(found, robust);
  for (const std::size_t i : found) {
    fit.outlier[i] = 1;
    use[i] = 0;
  }
  p.model(robust.parameters, fit.fitted, {});
  const Pass plain = minimise(p, robust.parameters, fit.fitted, use, 0.0, options);

  fit.parameters = plain.parameters;
  p.model(fit.parameters, fit.fitted, {});
  for (std::size_t i = 0; i < n; ++i) fit.residual[i] = (p.observed[i] - fit.fitted[i]) / fit.fitted[i];
  fit.degrees_of_freedom = std::max(0.0, static_cast<double>(plain.residual.size() - plain.jacobian.cols()));
  const double variance =
      fit.degrees_of_freedom > 0.0 ? plain.residual.squaredNorm() / fit.degrees_of_freedom : 0.0;
  fit.scatter = std::sqrt(variance);
  fit.told = plain.told;
  Matrix covariance = parameter_covariance(plain, variance);
  fit.correlation = successive_correlation(residuals_as_taken(p, options, fit));
  covariance *= widened_by_correlation(options, fit);
  fit.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return fit;
}

}  // namespace tremie
