#include "apparatus/l_box/engine.hpp"
#include "apparatus/l_box/engines.hpp"

namespace tremie::l_box {

Outcome run_3d(const Scene& scene, const Observer& observer) {
  return engine::with_law(scene.model, [&](const auto& law) { return run_in<ThreeD>(scene, law, observer); });
}

}  // namespace tremie::l_box
