#pragma once

// The implicit and the explicit run of the slump flow, compiled apart.

#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::slump_flow {

Outcome run_implicit(const Scene& scene, const Observer& observer);
Outcome run_explicit(const Scene& scene, const Observer& observer);

}  // namespace tremie::slump_flow
