#include "apparatus/slump_flow/implicit_run.hpp"
#include "apparatus/slump_flow/runs.hpp"

namespace tremie::slump_flow {

Outcome run_implicit(const Scene& scene, const Observer& observer) {
  return scene.model.space == SpaceKind::axisymmetric ? run_implicit_in<Axisymmetric>(scene, observer)
                                                      : run_implicit_in<ThreeD>(scene, observer);
}

}  // namespace tremie::slump_flow
