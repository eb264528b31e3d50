#pragma once

// What a run will cost, told before it: seconds and megabytes.

#include "apparatus/registry/registry.hpp"

namespace tremie::scene {

struct CostEstimate {
  double cpu = 0.0;                      ///< [s] of one processor
  double cpu_low = 0.0, cpu_high = 0.0;  ///< [s] between which it lies for the shipped scenes
  double cpu_most = 0.0;            ///< [s] where the flow does not come to rest before its duration is over
  double memory = 0.0, disk = 0.0;  ///< [bytes]
};

/// By rates measured on the shipped scenes with one core of an AMD EPYC of 2023 (Zen 4, AVX-512), good to a factor of two on
/// machines of today. `pace`: how many times as long a step takes on another (machine_pace.hpp), then good to 1.5.
CostEstimate cost_of(const Scene& scene, const SizeEstimate& estimate, std::optional<double> pace = {});

/// Why a run of this cost should not be begun, with its remedy: it needs more than `free_memory` [bytes], or more
/// than a day by so many threads. Empty where nothing is against it.
std::string objection(const CostEstimate& cost, double free_memory, int threads);

/// Throws InputError where there is an objection on this machine.
void check_cost(const Scene& scene, int threads);

/// 90 s, 5 min, 3 h, 12 days.
std::string duration_text(double seconds);
std::string megabytes_text(double bytes);

}  // namespace tremie::scene
