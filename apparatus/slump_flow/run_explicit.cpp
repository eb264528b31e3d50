#include "apparatus/slump_flow/engines.hpp"
#include "apparatus/slump_flow/explicit_engine.hpp"

namespace tremie::slump_flow {

Outcome run_explicit(const Scene& scene, const Observer& observer) {
  const auto run = [&](const auto& law) {
    return scene.model.space == SpaceKind::axisymmetric ? run_explicit_in<Axisymmetric>(scene, law, observer)
                                                        : run_explicit_in<ThreeD>(scene, law, observer);
  };
  return scene.model.yield == YieldKind::papanastasiou ? run(Papanastasiou{scene.model.regularisation})
                                                       : run(BiViscous{scene.model.critical_shear_rate});
}

}  // namespace tremie::slump_flow
