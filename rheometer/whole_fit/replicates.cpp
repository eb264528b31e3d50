#include "rheometer/whole_fit/replicates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

/// Half of an interval, to its wider side.
double half_width(const ParameterEstimate& e) {
  return std::max(e.ci95->high - e.value, e.value - e.ci95->low);
}

}  // namespace

/// The interval by the scatter between the records, never narrower than the narrowest of theirs: what a fit gets wrong, it
/// gets wrong in each.
std::optional<ReplicateMean> replicate_mean(const FitParameter& p,
                                            std::vector<std::optional<ParameterEstimate>> of_record,
                                            Sign sign) {
  std::vector<double> value, half;
  for (auto& e : of_record) {
    if (e && e->given) e.reset();
    if (!e) continue;
    value.push_back(e->value);
    if (e->ci95) half.push_back(half_width(*e));
  }
  if (value.empty()) return std::nullopt;
  const auto n = static_cast<double>(value.size());
  double mean = 0.0, square = 0.0, own = 0.0;
  for (const double v : value) mean += v / n;
  for (const double v : value) square += (v - mean) * (v - mean);
  for (const double h : half) own += h * h / (1.96 * 1.96) / static_cast<double>(half.size());
  ReplicateMean m{p, static_cast<int>(value.size()), {mean, std::nullopt, false}, {}, {}, {}, {}};
  std::optional<double> wide;
  if (!half.empty()) wide = *std::min_element(half.begin(), half.end());
  if (n >= 2.0) {
    const double deviation = std::sqrt(square / (n - 1.0));
    wide = std::max(wide.value_or(0.0), student_quantile(0.975, n - 1.0) * deviation / std::sqrt(n));
    if (mean > 0.0) m.between = deviation / mean;
  }
  if (wide && *wide > 0.0)  // copies of one record, without intervals of their own, tell none
    m.mean.ci95 = Interval{sign == Sign::any ? mean - *wide : std::max(0.0, mean - *wide), mean + *wide};
  if (!half.empty() && mean > 0.0) m.within = std::sqrt(own) / mean;
  m.of_record = std::move(of_record);
  return m;
}

std::vector<ReplicateMean> replicate_means(const std::vector<FitResult>& fits) {
  std::vector<ReplicateMean> means;
  for (const FitParameter& p : fit_parameters()) {
    std::vector<std::optional<ParameterEstimate>> of_record;
    for (const FitResult& fit : fits) of_record.push_back(value_of(fit, p));
    if (auto m = replicate_mean(p, std::move(of_record))) means.push_back(std::move(*m));
  }
  return means;
}

}  // namespace tremie
