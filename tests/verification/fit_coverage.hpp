#pragma once

// Fits of many noisy records of one known material: how often the truth lies in the 95 % interval.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "rheometer/fits/fit.hpp"
#include "tests/rheometer/synthetic_record.hpp"

namespace tremie::study {

struct Coverage {
  std::string name;
  double truth = 0.0;
  int covered = 0, missing = 0;  ///< missing: the fit reported null
  std::vector<double> values = {};

  void add(const std::optional<ParameterEstimate>& e) {
    if (!e || !e->ci95) {
      ++missing;
      return;
    }
    values.push_back(e->value);
    covered += e->ci95->low <= truth && truth <= e->ci95->high;
  }
};

/// Mix A by `readings` points of a flow curve from 0.05 to 0.5 rev/s.
inline std::vector<Coverage> flow_curve_coverage(int readings, double noise, int seeds) {
  std::vector<Coverage> c{{"yield_stress", 54.0}, {"plastic_viscosity", 35.8}};
  for (int seed = 1; seed <= seeds; ++seed) {
    const FitResult f = fit(synthetic::flow_curve(readings, noise, static_cast<std::uint64_t>(seed)), {});
    c[0].add(f.tau_0);
    c[1].add(f.mu);
  }
  return c;
}

/// White noise unless rho > 0; a drift of the torque over the record.
struct Noise {
  double rho = 0.0, drift = 0.0;
};

/// Mix A after 240 s of rest by 200 readings over 20 s; `each` sees every fit.
inline std::vector<Coverage> decay_coverage(bool tau_0_given, double noise, int seeds,
                                            const std::function<void(const FitResult&)>& each = {},
                                            const Noise& kind = {}) {
  const CouetteDecay exact = synthetic::exact_decay(synthetic::even_times(200, 20.0));
  FitInput input;
  input.omega = synthetic::omega;
  input.rest = synthetic::rest;
  input.mu = 35.8;
  if (tau_0_given) input.tau_0 = 54.0;
  std::vector<Coverage> c{{"flocculation_start", synthetic::lambda_0},
                          {"alpha", synthetic::alpha},
                          {"static_yield_stress", 366.0},
                          {"structuration_rate", 1.3}};
  if (!tau_0_given) c.push_back({"yield_stress", 54.0});
  std::vector<FitResult> fits(static_cast<std::size_t>(seeds));
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < seeds; ++i)
    fits[static_cast<std::size_t>(i)] = fit(
        synthetic::correlated_decay(exact, noise, kind.rho, kind.drift, static_cast<std::uint64_t>(i + 1)),
        input);
  for (const FitResult& f : fits) {
    const std::optional<ParameterEstimate>* found[] = {&f.lambda_0, &f.alpha, &f.static_yield_stress,
                                                       &f.A_thix, &f.tau_0};
    for (std::size_t k = 0; k < c.size(); ++k) c[k].add(*found[k]);
    if (each) each(f);
  }
  return c;
}

}  // namespace tremie::study
