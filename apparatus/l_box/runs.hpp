#pragma once

// The runs of the L-box in its geometries, compiled apart.

#include "apparatus/l_box/l_box.hpp"

namespace tremie::l_box {

Outcome run_plane(const Scene& scene, const scene::Observer& observer);
Outcome run_3d(const Scene& scene, const scene::Observer& observer);

}  // namespace tremie::l_box
