#pragma once

// The slump-flow test of EN 12350-8: an Abrams cone of concrete, lifted off a floor, and the spread that it leaves.

#include <vector>

#include "apparatus/common/apparatus.hpp"
#include "apparatus/parts/cone/cone_test.hpp"

namespace tremie::slump_flow {

/// The keys of `apparatus = "slump_flow"`.
scene::ApparatusKeys keys();

/// Runs the test and reads it.
scene::Outcome run(const cone::Scene& scene, const scene::RunOptions& options,
                   const scene::Observer& observer);

/// What error bars are for, and what the names of readings mean.
std::vector<scene::Headline> headlines();
std::vector<scene::Described> glossary();

}  // namespace tremie::slump_flow
