#pragma once

#include <functional>

#include "libmpm/body/archive.hpp"

namespace tremie {

/// Who keeps the state of a run while it goes on, so that another can go on from it to the same bits.
struct Checkpoints {
  std::function<bool()> due;                       ///< asked between two steps
  std::function<void(const VisitState&)> keep;     ///< writes the state
  std::function<void(const VisitState&)> restore;  ///< reads one to go on from; empty: from the start
};

/// Whether a run goes on from where an earlier one stood.
inline bool goes_on(const Checkpoints* checkpoints) { return checkpoints && checkpoints->restore; }

}  // namespace tremie
