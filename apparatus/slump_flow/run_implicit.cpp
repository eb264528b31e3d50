#include "apparatus/slump_flow/engine.hpp"
#include "apparatus/slump_flow/engines.hpp"

namespace tremie::slump_flow {

Outcome run_implicit(const Scene& scene, const Observer& observer) {
  return engine::with_law(scene.model, [&](const auto& law) {
    return scene.model.space == SpaceKind::axisymmetric ? run_in<Axisymmetric>(scene, law, observer)
                                                        : run_in<ThreeD>(scene, law, observer);
  });
}

}  // namespace tremie::slump_flow
