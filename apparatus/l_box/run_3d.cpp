#include "apparatus/l_box/implicit_run.hpp"

namespace tremie::l_box {

Outcome run_3d(const Scene& scene, const scene::Observer& observer) {
  return run_in<ThreeD>(scene, observer);
}

}  // namespace tremie::l_box
