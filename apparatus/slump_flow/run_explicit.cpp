#include "apparatus/slump_flow/explicit_run.hpp"
#include "apparatus/slump_flow/set_up.hpp"

namespace tremie::slump_flow {

Outcome run_explicit(const Scene& scene, const Observer& observer) {
  return scene.model.space == SpaceKind::axisymmetric
             ? run_explicit_in<Axisymmetric>(scene, scene.model.law, observer)
             : run_explicit_in<ThreeD>(scene, scene.model.law, observer);
}

}  // namespace tremie::slump_flow
