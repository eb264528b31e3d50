#include "apparatus/l_box/engine.hpp"
#include "apparatus/l_box/engines.hpp"

namespace tremie::l_box {

Outcome run_in_the_plane(const Scene& scene, const Observer& observer) { return run_in<PlaneStrain>(scene, observer); }

}  // namespace tremie::l_box
