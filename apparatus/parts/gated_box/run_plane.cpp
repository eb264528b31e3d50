#include "apparatus/parts/gated_box/implicit_run.hpp"

namespace tremie::gated_box {

Outcome run_plane(const Scene& scene, const scene::Observer& observer, ProgressText text) {
  return run_in<PlaneStrain>(scene, observer, text);
}

}  // namespace tremie::gated_box
