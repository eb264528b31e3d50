#include "rheometer/whole_fit/replicates.hpp"

#include <algorithm>
#include <cmath>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

std::optional<ReplicateMean> mean_of(const FitParameter& p, const std::vector<FitResult>& fits) {
  std::vector<double> value, error;
  for (const FitResult& f : fits) {
    const std::optional<ParameterEstimate> e = value_of(f, p);
    if (!e || e->given) continue;
    value.push_back(e->value);
    if (e->ci95) error.push_back((e->ci95->high - e->value) / 1.96);
  }
  if (value.empty()) return std::nullopt;
  const auto n = static_cast<double>(value.size());
  double mean = 0.0, square = 0.0, own = 0.0;
  for (const double v : value) mean += v / n;
  for (const double v : value) square += (v - mean) * (v - mean);
  for (const double e : error) own += e * e / static_cast<double>(error.size());
  ReplicateMean m{p, static_cast<int>(value.size()), {mean, std::nullopt, false}, {}, {}};
  if (n >= 2.0) {
    const double deviation = std::sqrt(square / (n - 1.0));
    const double half = student_quantile(0.975, n - 1.0) * deviation / std::sqrt(n);
    m.mean.ci95 = Interval{std::max(0.0, mean - half), mean + half};
    if (mean > 0.0) m.between = deviation / mean;
  }
  if (!error.empty() && mean > 0.0) m.within = std::sqrt(own) / mean;
  return m;
}

}  // namespace

std::vector<ReplicateMean> replicate_means(const std::vector<FitResult>& fits) {
  std::vector<ReplicateMean> means;
  for (const FitParameter& p : fit_parameters())
    if (auto m = mean_of(p, fits)) means.push_back(*m);
  return means;
}

}  // namespace tremie
