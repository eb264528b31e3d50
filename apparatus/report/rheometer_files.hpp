#pragma once

// What the commands of the rheometer write beside what a run writes.

#include <signal.h>

#include <nlohmann/json_fwd.hpp>

#include "apparatus/common/outcome.hpp"

namespace tremie::cli {

/// The blocks of summary.json that every apparatus has, null where a rheometer has no such thing (points
/// lost, cells).
nlohmann::ordered_json summary_of(scene::Outcome outcome);

/// While it lives, an interrupt waits: files are written to their end, or their folder taken away, in less
/// than a second or two. It ends the program where the hold ends.
class HeldInterrupts {
 public:
  HeldInterrupts();
  ~HeldInterrupts();
  HeldInterrupts(const HeldInterrupts&) = delete;
  HeldInterrupts& operator=(const HeldInterrupts&) = delete;

 private:
  sigset_t before_;
};

}  // namespace tremie::cli
