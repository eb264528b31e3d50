#include "rheometer/fits/flow_curve/flow_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace tremie::fitting {

namespace {

std::vector<double> with(const FittedLaw& fitted, std::span<const double> p) {
  std::vector<double> all = fitted.all;
  for (std::size_t i = 0; i < p.size(); ++i) all[fitted.free[i]] = p[i];
  return all;
}

/// The readings in the order of the file.
std::vector<std::size_t> order_of_lines(const Readings& r) {
  std::vector<std::size_t> order(r.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return r.line[a] < r.line[b]; });
  return order;
}

}  // namespace

std::optional<double> given_value(const FitInput& input, const LawParameter& p) {
  return p.row.member == &FitResult::tau_0 ? input.tau_0
         : p.row.member == &FitResult::mu  ? input.mu
                                           : std::nullopt;
}

bool several_speeds(const Readings& r) { return r.size() >= 2 && r.x.back() > r.x.front() * (1.0 + 1e-9); }

FittedLaw least_squares(const Readings& r, const FitInput& input, const FlowLaw& law, Outliers outliers) {
  std::vector<FlowPoint> points;
  for (std::size_t i = 0; i < r.size(); ++i) points.push_back({r.x[i], r.torque[i]});
  FittedLaw fitted{&law, law.start(bingham_from_flow_curve(points, input.instrument)), {}, {}};
  LeastSquaresProblem problem;
  problem.observed = r.torque;
  problem.count = r.count;
  for (std::size_t k = 0; k < law.parameters.size(); ++k) {
    if (const auto value = given_value(input, law.parameters[k])) {
      fitted.all[k] = *value;
      continue;
    }
    fitted.free.push_back(k);
    problem.start.push_back(fitted.all[k]);
    problem.lower.push_back(law.parameters[k].lower);
    problem.upper.push_back(law.parameters[k].upper);
  }
  problem.model = [&](std::span<const double> p, std::span<double> torque, std::span<double> jacobian) {
    const std::vector<double> all = with(fitted, p);
    for (std::size_t i = 0, at = 0; i < r.size(); ++i) {
      const FlowTorque t = law.torque(all, r.x[i], input.instrument);
      torque[i] = t.torque;
      if (jacobian.empty()) continue;
      for (const std::size_t k : fitted.free) jacobian[at++] = t.slope[k];
    }
    return std::all_of(torque.begin(), torque.end(), [](double t) { return t > 0.0; });
  };
  LeastSquaresOptions options;
  options.taken = order_of_lines(r);
  options.find_outliers = outliers == Outliers::found;
  fitted.fit = fit_least_squares(problem, options);
  fitted.all = with(fitted, fitted.fit.parameters);
  return fitted;
}

const LawParameter* at_bound(const FittedLaw& f) {
  constexpr double near = 1e-3;
  for (std::size_t k = 0; k < f.all.size(); ++k) {
    const LawParameter& p = f.law->parameters[k];
    if (p.has_range() && (f.all[k] < p.lower + near || f.all[k] > p.upper - near)) return &p;
  }
  return nullptr;
}

double misfit(const FittedLaw& f) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < f.fit.residual.size(); ++i)
    if (!f.fit.outlier[i]) sum += f.fit.residual[i] * f.fit.residual[i], n += 1.0;
  return std::sqrt(sum / std::max(1.0, n));
}

}  // namespace tremie::fitting
