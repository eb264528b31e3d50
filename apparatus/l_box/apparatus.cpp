#include "apparatus/l_box/apparatus.hpp"

#include "apparatus/l_box/keys.hpp"
#include "apparatus/l_box/outcome.hpp"

namespace tremie::l_box {

scene::Apparatus apparatus() {
  return scene::make_apparatus<Scene>(
      scene::l_box_keys(),
      {{"passing_ratio", "passing ratio", "", 3},
       {"h1_mm", "H1", "mm", 0},
       {"h2_mm", "H2", "mm", 0},
       {"t400_s", "t400", "s", 2}},
      scene::l_box_scene, scene::l_box_uses,
      [](const Scene& scene, const scene::RunOptions& options, const scene::Observer& observer) {
        return scene::run_l_box(scene, options.measured, options.all_frames, observer);
      },
      [](const Scene& scene) { return estimate(scene); });
}

}  // namespace tremie::l_box
