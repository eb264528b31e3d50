#include "apparatus/parts/cone/explicit_run.hpp"
#include "apparatus/parts/cone/set_up.hpp"

namespace tremie::cone {

Outcome run_explicit(const Scene& scene, const scene::Observer& observer) {
  return scene.model.space == SpaceKind::axisymmetric
             ? run_explicit_in<Axisymmetric>(scene, scene.model.law, observer)
             : run_explicit_in<ThreeD>(scene, scene.model.law, observer);
}

}  // namespace tremie::cone
