#include "apparatus/l_box/engine.hpp"
#include "apparatus/l_box/engines.hpp"

namespace tremie::l_box {

Outcome run_3d(const Scene& scene, const Observer& observer) { return run_in<ThreeD>(scene, observer); }

}  // namespace tremie::l_box
