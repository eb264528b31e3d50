#pragma once

// The engines of the L-box, compiled apart.

#include "apparatus/l_box/l_box.hpp"

namespace tremie::l_box {

Outcome run_in_the_plane(const Scene& scene, const Observer& observer);
Outcome run_3d(const Scene& scene, const Observer& observer);

}  // namespace tremie::l_box
