#include "rheometer/fits/replicates.hpp"

#include <algorithm>
#include <cmath>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

struct Parameter {
  const char *name, *unit;
  std::optional<Estimate> FitResult::*member;
  std::optional<double> laboratories;
};

// Haist et al. (2020), doi 10.1617/s11527-020-01477-w: one cement paste in the rheometers of several laboratories.
const Parameter parameters[] = {{"yield_stress", "Pa", &FitResult::tau_0, 0.27},
                                {"plastic_viscosity", "Pa s", &FitResult::mu, 0.24},
                                {"static_yield_stress", "Pa", &FitResult::static_yield_stress, std::nullopt},
                                {"flocculation_start", "", &FitResult::lambda_0, std::nullopt},
                                {"alpha", "", &FitResult::alpha, std::nullopt},
                                {"exponent", "", &FitResult::exponent, std::nullopt},
                                {"structuration_rate", "Pa/s", &FitResult::A_thix, std::nullopt},
                                {"consistency", "Pa s^n", &FitResult::consistency, std::nullopt},
                                {"flow_index", "", &FitResult::flow_index, std::nullopt}};

std::optional<ReplicateMean> mean_of(const Parameter& p, const std::vector<FitResult>& fits) {
  std::vector<double> value, error;
  for (const FitResult& f : fits) {
    const std::optional<Estimate>& e = f.*p.member;
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
  ReplicateMean m{p.name, p.unit,        static_cast<int>(value.size()), {mean, std::nullopt, false}, {},
                  {},     p.laboratories};
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

const std::optional<Estimate>& value_of(const FitResult& fit, const ReplicateMean& parameter) {
  return fit.*std::find_if(std::begin(parameters), std::end(parameters), [&](const Parameter& p) {
                return p.name == parameter.name;
              })->member;
}

std::vector<ReplicateMean> replicate_means(const std::vector<FitResult>& fits) {
  std::vector<ReplicateMean> means;
  for (const Parameter& p : parameters)
    if (auto m = mean_of(p, fits)) means.push_back(*m);
  return means;
}

}  // namespace tremie
