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

/// By rates measured on the shipped scenes (Zen 4 and Xeon processors of 2023), good to a factor of two.
CostEstimate cost_of(const Scene& scene, const Estimate& estimate);

}  // namespace tremie::scene
