#include "apparatus/report/rheometer_files.hpp"

#include <nlohmann/json.hpp>

#include "apparatus/report/summary.hpp"

namespace tremie::cli {

nlohmann::ordered_json summary_of(scene::Outcome outcome) {
  outcome.has_points = false;
  return report::run_summary(outcome);
}

HeldInterrupts::HeldInterrupts() {
  sigset_t held;
  sigemptyset(&held);
  for (const int number : {SIGINT, SIGTERM}) sigaddset(&held, number);
  sigprocmask(SIG_BLOCK, &held, &before_);
}

HeldInterrupts::~HeldInterrupts() { sigprocmask(SIG_SETMASK, &before_, nullptr); }

}  // namespace tremie::cli
