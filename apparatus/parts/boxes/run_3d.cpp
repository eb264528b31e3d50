#include "apparatus/parts/boxes/implicit_run.hpp"

namespace tremie::boxes {

Outcome run_3d(const Scene& scene, const scene::Observer& observer, ProgressText text) {
  return run_in<ThreeD>(scene, observer, text);
}

}  // namespace tremie::boxes
