#include "apparatus/slump_flow/engine.hpp"
#include "apparatus/slump_flow/engines.hpp"

namespace tremie::slump_flow {

Outcome run_implicit(const Scene& scene, const Observer& observer) {
  return scene.model.space == SpaceKind::axisymmetric ? run_in<Axisymmetric>(scene, observer)
                                                      : run_in<ThreeD>(scene, observer);
}

}  // namespace tremie::slump_flow
