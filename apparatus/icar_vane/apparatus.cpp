#include "apparatus/icar_vane/apparatus.hpp"

#include "apparatus/icar_vane/keys.hpp"
#include "apparatus/icar_vane/outcome.hpp"

namespace tremie::icar_vane {

scene::Apparatus apparatus() {
  return scene::make_apparatus<Scene>(
      scene::icar_vane_keys(),
      {{"torque_end_N_m", "torque at the end", "N m", 4}, {"torque_peak_N_m", "torque peak", "N m", 4}},
      scene::icar_vane_scene, scene::icar_vane_uses,
      [](icar_vane::Scene scene, const scene::RunOptions& options, const scene::Observer& observer) {
        scene.with_reference = scene.with_reference && !options.coarser;
        return scene::run_icar_vane(scene, options.measured, options.all_frames, observer);
      },
      [](const Scene& scene) { return estimate(scene); });
}

}  // namespace tremie::icar_vane
