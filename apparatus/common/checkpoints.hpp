#pragma once

#include <functional>

namespace tremie {

class Archive;

/// All that goes on from one step to the next, as libmpm/body/archive.hpp visits it.
using VisitState = std::function<void(Archive&)>;

/// Who keeps the state of a run while it goes on, so that another can go on from it to the same bits.
struct Checkpoints {
  std::function<bool()> due;                       ///< asked between two steps
  std::function<void(const VisitState&)> keep;     ///< writes the state
  std::function<void(const VisitState&)> restore;  ///< reads one to go on from; empty: from the start
  /// Writes the last state that does not depend on the test's end, from which a longer test can continue; empty: not kept.
  std::function<void(const VisitState&)> keep_for_longer = {};
};

/// Whether a run goes on from where an earlier one stood.
inline bool goes_on(const Checkpoints* checkpoints) { return checkpoints && checkpoints->restore; }

}  // namespace tremie
