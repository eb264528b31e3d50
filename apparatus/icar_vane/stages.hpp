#pragma once

// The speeds that a test goes through, one after the other.

#include <vector>

#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::icar_vane {

/// A speed held for a time.
struct Stage {
  double speed = 0.0, duration = 0.0;  ///< [rev/s], [s]
};

inline std::vector<Stage> stages_of(const Scene& scene) {
  if (scene.speeds.empty()) return {{scene.speed, scene.duration}};
  std::vector<Stage> stages = {{scene.pre_shear_speed, scene.pre_shear_time}};
  for (double speed : scene.speeds) stages.push_back({speed, scene.hold_time});
  return stages;
}

}  // namespace tremie::icar_vane
