#pragma once

// How often the 95 % intervals of k and a hold the truth, over made records of different seeds.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "rheometer/protocol/breakdown.hpp"
#include "tests/rheometer/made_protocol.hpp"

namespace tremie::made {

struct Case {
  const char* name;
  Material material;
  Noise noise;
};

/// By time with white noise, by time with correlated noise, and in two modes half-way to strain with correlated noise.
inline std::vector<Case> cases() {
  Material modes;
  modes.a = 0.4, modes.modes = {{0.7, 1.0}, {0.3, 0.1}};
  return {{"one mode, a = 0.1, white noise", {}, {0.01, 0.0}},
          {"one mode, a = 0.1, correlation 0.7", {}, {0.01, 0.7}},
          {"two modes, a = 0.4, correlation 0.7", modes, {0.01, 0.7}}};
}

struct Covered {
  int k = 0, a = 0, missing = 0;
  std::vector<double> exponents;  ///< sorted
  double quantile(double share) const {
    return exponents[static_cast<std::size_t>(share * static_cast<double>(exponents.size() - 1))];
  }
  double median() const { return quantile(0.5); }
  /// Standard error of the median: that of normal noise, whose quartiles lie 1.35 standard deviations apart.
  double error_of_median() const {
    return 1.25 * (quantile(0.75) - quantile(0.25)) / 1.35 / std::sqrt(static_cast<double>(exponents.size()));
  }
};

inline Covered coverage_of(const Case& c, int seeds) {
  Covered covered;
#pragma omp parallel for schedule(dynamic)
  for (int seed = 1; seed <= seeds; ++seed) {
    const ProtocolRecord record = record_of(c.material, c.noise, static_cast<unsigned>(seed));
    const Breakdown b = breakdown_of(falls_of(record, find_sections(record)), evenly_sheared(), false);
    const auto holds = [](const ParameterEstimate& e, double truth) {
      return e.ci95->low <= truth && truth <= e.ci95->high;
    };
#pragma omp critical
    if (!b.exponent || !b.exponent->ci95) {
      ++covered.missing;
    } else {
      covered.k += holds(*b.rate, c.material.k);
      covered.a += holds(*b.exponent, c.material.a);
      covered.exponents.push_back(b.exponent->value);
    }
  }
  std::sort(covered.exponents.begin(), covered.exponents.end());
  std::printf("%s: %d records, k in %d intervals, a in %d, median a %.4f ± %.4f, none in %d\n", c.name, seeds,
              covered.k, covered.a, covered.median(), covered.error_of_median(), covered.missing);
  return covered;
}

}  // namespace tremie::made
