#include "apparatus/slump_flow/apparatus.hpp"

#include "apparatus/slump_flow/scene.hpp"

namespace tremie::slump_flow {

scene::Apparatus apparatus() {
  return scene::make_apparatus<Scene>(
      scene::slump_flow_keys(),
      {{"spread_mm", "spread", "mm", 0}, {"height_mm", "height", "mm", 1}, {"t500_s", "t500", "s", 2}},
      scene::slump_flow_scene, scene::slump_flow_uses,
      [](const Scene& scene, const scene::RunOptions& options, const scene::Observer& observer) {
        return scene::run_slump_flow(scene, options.measured, options.all_frames, observer);
      },
      [](const Scene& scene) { return estimate(scene); });
}

}  // namespace tremie::slump_flow
