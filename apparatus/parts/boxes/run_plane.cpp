#include "apparatus/parts/boxes/implicit_run.hpp"

namespace tremie::boxes {

Outcome run_plane(const Scene& scene, const scene::Observer& observer, ProgressText text) {
  return run_in<PlaneStrain>(scene, observer, text);
}

}  // namespace tremie::boxes
