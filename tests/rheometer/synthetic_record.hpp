#pragma once

// Torque records of a known material with noise of a known seed, for the tests of the fit.

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "rheometer/records/torque_record.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie::synthetic {

inline const Bingham mix_a{54.0, 35.8};
inline constexpr double lambda_0 = 1.3 * 240.0 / 54.0, alpha = 0.0358, rest = 240.0;
inline const double omega = angular_speed(0.25);

inline void finish(TorqueRecord& record, double noise, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (double& torque : record.torque) {
    if (noise > 0.0) torque *= 1.0 + noise * normal(generator);
    record.line.push_back(static_cast<long>(record.line.size()) + 2);
  }
}

/// `n` speeds from 0.05 to 0.5 rev/s.
inline TorqueRecord flow_curve(int n, double noise = 0.0, std::uint64_t seed = 1,
                               const Bingham& mix = mix_a) {
  TorqueRecord record;
  record.kind = RecordKind::flow_curve;
  for (int i = 0; i < n; ++i) {
    record.omega.push_back(angular_speed(0.05 + 0.45 * i / (n - 1)));
    record.torque.push_back(reiner_riwlin(mix, record.omega.back()).torque);
  }
  finish(record, noise, seed);
  return record;
}

inline std::vector<double> even_times(int n, double end) {
  std::vector<double> times;
  for (int i = 0; i < n; ++i) times.push_back(end * i / (n - 1));
  return times;
}

/// Mix A after 240 s of rest at 0.25 rev/s; the torque of a grid eight times finer than the fit's.
inline CouetteDecay exact_decay(const std::vector<double>& times) {
  const CouetteFlow flow{mix_a, {1.3, GatedKinetics{alpha}, lambda_0}, omega, {}};
  CouetteOptions options;
  options.intervals = 800;
  options.relative_tolerance = 1e-8;
  options.absolute_tolerance = 1e-9;
  options.whole_gap = false;
  return thixotropic_couette(flow, times, {}, options);
}

/// Noise of an instrument: correlated over neighbouring readings by `rho`, and a drift of `drift` of the torque over the
/// record that starts again with every seed.
inline TorqueRecord correlated_decay(const CouetteDecay& exact, double noise, double rho, double drift,
                                     std::uint64_t seed) {
  TorqueRecord record;
  record.kind = RecordKind::torque_decay;
  record.time = exact.time;
  record.torque = exact.torque;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  const double slope = drift * normal(generator);
  double state = noise * normal(generator);
  for (std::size_t i = 0; i < record.torque.size(); ++i) {
    record.torque[i] *= 1.0 + state + slope * (exact.time[i] / exact.time.back() - 0.5);
    state = rho * state + std::sqrt(1.0 - rho * rho) * noise * normal(generator);
    record.line.push_back(static_cast<long>(i) + 2);
  }
  return record;
}

inline TorqueRecord torque_decay(const CouetteDecay& exact, double noise = 0.0, std::uint64_t seed = 1) {
  TorqueRecord record;
  record.kind = RecordKind::torque_decay;
  record.time = exact.time;
  record.torque = exact.torque;
  finish(record, noise, seed);
  return record;
}

}  // namespace tremie::synthetic
